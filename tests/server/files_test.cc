// Which files clients may name.
#include "server/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "core/error.h"
#include "io/companion.h"
#include "io/grid_reader.h"
#include "io/hdf5_file.h"

namespace motes::server {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A shared folder and a secret beside it.
class FilesTest : public testing::Test {
 protected:
  FilesTest() {
    std::string pattern = (fs::temp_directory_path() / "motes-files-XXXXXX").string();
    root_ = fs::canonical(mkdtemp(pattern.data()));
    fs::create_directories(root_ / "shared/sub");
    fs::create_directories(root_ / "shared2");
    write("secret.xyz");
    write("shared2/other.xyz");
    write("shared/run.xyz");
    write("shared/sub/a b.xyz");
    write("shared/.hidden");
    fs::create_symlink(root_ / "secret.xyz", root_ / "shared/link.xyz");
    fs::create_directory_symlink(root_, root_ / "shared/up");
    fs::create_symlink("run.xyz", root_ / "shared/inner.xyz");
    fs::create_symlink("nowhere", root_ / "shared/dangling");
  }
  ~FilesTest() override { fs::remove_all(root_); }

  void write(const std::string& name) { std::ofstream(root_ / name) << "1\n\nC 0 0 0\n"; }
  std::string secret() const { return (root_ / "secret.xyz").string(); }

  fs::path root_;
};

TEST_F(FilesTest, InTheFolderAreTaken) {
  const Files files(root_ / "shared", 1000);
  EXPECT_EQ(files.resolve("run.xyz"), root_ / "shared/run.xyz");
  EXPECT_EQ(files.resolve("sub/../run.xyz"), root_ / "shared/run.xyz");
  EXPECT_EQ(files.resolve("sub/a b.xyz"), root_ / "shared/sub/a b.xyz");
  EXPECT_EQ(files.resolve((root_ / "shared/run.xyz").string()), root_ / "shared/run.xyz");
  EXPECT_EQ(files.resolve("inner.xyz"), root_ / "shared/run.xyz");
  EXPECT_EQ(files.resolve(""), root_ / "shared");
}

TEST_F(FilesTest, OutsideAreRefusedAsIfTheyWereNotThere) {
  const Files files(root_ / "shared", 1000);
  for (const std::string& path :
       {std::string("../secret.xyz"), secret(), std::string("link.xyz"),
        std::string("up/secret.xyz"), std::string("sub/../../secret.xyz"),
        std::string("/etc/passwd"), std::string("../shared2/other.xyz"),
        (root_ / "shared2/other.xyz").string(), std::string("run.xyz\0.png", 12),
        std::string("absent.xyz"), std::string("dangling"), std::string("%2e%2e/secret.xyz"),
        std::string("..\\secret.xyz"), std::string("~/x")}) {
    try {
      files.resolve(path);
      FAIL() << path;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("there is no such file"));
    }
  }
}

TEST_F(FilesTest, AreListedWithoutWhatLeadsOut) {
  const Folder folder(root_ / "shared");
  std::vector<std::string> names;
  for (const FolderEntry& entry : folder.list("")) names.push_back(entry.name);
  EXPECT_THAT(names, testing::ElementsAre("sub", "inner.xyz", "run.xyz"));
  EXPECT_THROW(folder.list(".."), Error);
  EXPECT_THROW(folder.list("up"), Error);
  EXPECT_THROW(folder.list("run.xyz"), Error);
}

TEST_F(FilesTest, OfScenesAreHeldToTheSame) {
  const Files files(root_ / "shared", 1000);
  const fs::path shared = root_ / "shared";
  const Scene good = files.parse_scene(R"({"version":1,"data":{"path":"sub/a b.xyz"}})", shared);
  EXPECT_EQ(good.data_path, shared / "sub/a b.xyz");
  for (const std::string& part :
       {"\"data\":{\"path\":\"" + secret() + "\"}",
        std::string(R"("data":{"path":"../secret.xyz"})"),
        "\"data\":{\"path\":\"run.xyz\"},\"kernel\":{\"type\":\"tabulated\",\"path\":\"" +
            secret() + "\"}",
        "\"data\":{\"path\":\"run.xyz\"},\"fields\":[{\"grid\":\"" + secret() + "\"}]",
        "\"data\":{\"path\":\"run.xyz\"},\"fields\":[{\"grid\":{\"path\":\"" + secret() + "\"}}]",
        "\"data\":{\"path\":\"run.xyz\"},\"fields\":[{\"kernel\":{\"type\":\"tabulated\",\"path\":"
        "\"" +
            secret() + "\"}}]"}) {
    try {
      files.parse_scene("{\"version\":1," + part + "}", shared);
      FAIL() << part;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("there is no such file")) << part;
    }
  }
}

TEST_F(FilesTest, ThatTheUserHasOpenedAreTaken) {
  Files files(root_ / "shared", 1000);
  Scene scene;
  scene.data_path = secret();
  files.allow(scene);
  EXPECT_EQ(files.resolve(secret()), secret());
  EXPECT_THROW(files.resolve((root_ / "shared2/other.xyz").string()), Error);
}

void write_hdf5(const fs::path& path, const std::function<void(hid_t)>& fill) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  fill(file);
  H5Fclose(file);
}

hid_t one_number(hid_t file, const char* name, hid_t creation) {
  const hsize_t size = 1;
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t set =
      H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  H5Sclose(space);
  return H5Dclose(set);
}

// What a file holds is shown to whoever opens it; what it points to is not.
TEST_F(FilesTest, ThatReferToOthersElsewhereAreRefused) {
  const fs::path shared = root_ / "shared", values = root_ / "values.raw";
  std::ofstream(values) << std::string(8, 'x');
  fs::copy_file(values, shared / "beside.raw");
  fs::create_symlink(values, shared / "link.raw");
  write_hdf5(root_ / "other.h5", [](hid_t file) { one_number(file, "d", H5P_DEFAULT); });
  write_hdf5(shared / "linked.h5", [&](hid_t file) {
    H5Lcreate_external((root_ / "other.h5").c_str(), "d", file, "d", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(creation, values.c_str(), 0, 8);
    one_number(file, "e", creation);
    H5Pclose(creation);
  });
  if (!keeps_to_own_directories()) {
    EXPECT_TRUE(Hdf5File(shared / "linked.h5", {}).has_dataset("d"));
  }
  keep_to_own_directories();
  const auto header = [&](const std::string& name, const std::string& data) {
    std::ofstream(shared / name) << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\n"
                                    "encoding: raw\ndata file: "
                                 << data << "\n\n";
    return shared / name;
  };
  EXPECT_NO_THROW(read_grids(header("good.nhdr", "beside.raw"), {}));
  for (const std::string& data : {values.string(), std::string("../values.raw"),
                                  std::string("link.raw"), std::string("/etc/passwd")}) {
    try {
      read_grids(header("bad.nhdr", data), {});
      FAIL() << data;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("expected a file beside it")) << data;
    }
  }
  const Hdf5File linked(shared / "linked.h5", {});
  EXPECT_FALSE(linked.has_dataset("d"));
  EXPECT_THROW(linked.shape("e"), Error);
}

TEST_F(FilesTest, ThatAreSentHaveAPlaceUntilTheEnd) {
  fs::path first, second;
  {
    Files files(root_ / "shared", 1000);
    const auto place_for = [&files](std::string_view name) {
      return files.with_uploads([name](Uploads& uploads) { return uploads.place_for(name); });
    };
    first = place_for("dir/../x.xyz");
    second = place_for("x.xyz");
    EXPECT_EQ(first.filename(), "x.xyz");
    EXPECT_NE(first, second);
    std::ofstream(first) << "1\n";
    EXPECT_EQ(files.resolve(first.string()), first);
    // Scenes name them as their users do; what lies in the folder comes first.
    const std::string sent = R"({"version":1,"data":{"path":"x.xyz"}})";
    EXPECT_THROW(files.parse_scene(sent, root_ / "shared"), Error);  // it has not come whole yet
    files.with_uploads([&](Uploads& uploads) { uploads.complete(first); });
    EXPECT_EQ(files.parse_scene(sent, root_ / "shared").data_path, first);
    write("shared/x.xyz");
    EXPECT_EQ(files.parse_scene(sent, root_ / "shared").data_path, root_ / "shared/x.xyz");
    for (const char* name : {"", ".", "..", "a/", "/"})
      EXPECT_THROW(place_for(name), Error) << name;
  }
  EXPECT_FALSE(fs::exists(first));
}

TEST(Uploads, MakeRoomForNewOnesAndNoMore) {
  Uploads uploads(100);
  const auto send = [&uploads](const char* name, std::uint64_t bytes) {
    fs::path place = uploads.place_for(name);
    std::ofstream(place) << "x";
    EXPECT_TRUE(uploads.grow(place, bytes, {}));
    uploads.complete(place);
    return place;
  };
  const fs::path oldest = send("a", 40), older = send("b", 40), partial = uploads.place_for("c");
  std::ofstream(partial) << "x";
  // What is in use stays, and nothing goes where that would not help.
  EXPECT_FALSE(uploads.grow(partial, 70, {oldest}));
  EXPECT_TRUE(fs::exists(older));
  EXPECT_TRUE(uploads.grow(partial, 50, {oldest}));
  EXPECT_TRUE(fs::exists(oldest));
  EXPECT_FALSE(fs::exists(older.parent_path()));
  // So does what is being sent.
  EXPECT_FALSE(uploads.grow(uploads.place_for("d"), 60, {}));
  EXPECT_TRUE(uploads.grow(partial, 50, {}));
  EXPECT_FALSE(fs::exists(oldest));
  EXPECT_FALSE(uploads.grow(partial, 1, {}));
  uploads.remove(partial);
  EXPECT_FALSE(fs::exists(partial));
  send("e", 100);
}

}  // namespace
}  // namespace motes::server
