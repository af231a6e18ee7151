// Which files clients may name.
#include "server/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"

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
  const Files files(root_ / "shared");
  EXPECT_EQ(files.resolve("run.xyz"), root_ / "shared/run.xyz");
  EXPECT_EQ(files.resolve("sub/../run.xyz"), root_ / "shared/run.xyz");
  EXPECT_EQ(files.resolve("sub/a b.xyz"), root_ / "shared/sub/a b.xyz");
  EXPECT_EQ(files.resolve((root_ / "shared/run.xyz").string()), root_ / "shared/run.xyz");
  EXPECT_EQ(files.resolve("inner.xyz"), root_ / "shared/run.xyz");
  EXPECT_EQ(files.resolve(""), root_ / "shared");
}

TEST_F(FilesTest, OutsideAreRefusedAsIfTheyWereNotThere) {
  const Files files(root_ / "shared");
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
  const Files files(root_ / "shared");
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
  Files files(root_ / "shared");
  Scene scene;
  scene.data_path = secret();
  files.allow(scene);
  EXPECT_EQ(files.resolve(secret()), secret());
  EXPECT_THROW(files.resolve((root_ / "shared2/other.xyz").string()), Error);
}

TEST_F(FilesTest, ThatAreSentHaveAPlaceUntilTheEnd) {
  fs::path first, second;
  {
    Files files(root_ / "shared");
    first = files.place_for_upload("dir/../x.xyz");
    second = files.place_for_upload("x.xyz");
    EXPECT_EQ(first.filename(), "x.xyz");
    EXPECT_NE(first, second);
    std::ofstream(first) << "1\n";
    EXPECT_EQ(files.resolve(first.string()), first);
    for (const char* name : {"", ".", "..", "a/", "/"}) {
      EXPECT_THROW(files.place_for_upload(name), Error) << name;
    }
  }
  EXPECT_FALSE(fs::exists(first));
}

}  // namespace
}  // namespace motes::server
