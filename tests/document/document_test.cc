#include "document/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <thread>

#include "core/error.h"
#include "image/compare.h"
#include "support/temporary_directory.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const TransferFunction ramp{{{0.1, {0, 0, 1}, 0}, {1.5, {1, 1, 0}, 1.5}}, false};

/// Three frames of 60 atoms, silicon and oxygen, that move a little.
class DocumentTest : public testing::Test {
 protected:
  DocumentTest() {
    std::ofstream file(path());
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-4, 4);
    std::vector<Point3d> points(60);
    for (Point3d& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
    for (int frame = 0; frame < 3; ++frame) {
      file << "60\n\n";
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Point3d& p = points[i];
        file << (i % 3 == 0 ? "Si " : "O ") << p.x + 0.1 * frame << " " << p.y << " " << p.z
             << "\n";
      }
    }
  }

  std::filesystem::path path() const { return directory_ / "run.xyz"; }
  Document open(const Scene& scene) { return Document::open(path(), scene, nullptr, warnings_); }
  Scene scene() const {
    Scene scene = open_scene(path());
    scene.render.width = scene.render.height = 33;
    scene.render.surface.occlusion_samples = 4;
    return scene;
  }
  static Framebuffer picture(const Document& document) {
    Framebuffer image;
    document.render(document.camera(), 33, 33, {}, nullptr, image);
    return image;
  }
  Change change(Document& document, const Scene& scene) {
    return document.set_scene(scene, nullptr, warnings_);
  }

  TemporaryDirectory directory_;
  Warnings warnings_;
};

/// One edit of a scene with the fields Si and O, drawn at random; some are mistakes.
void edit(Scene& scene, std::mt19937& random) {
  Field& field = scene.fields[random() % scene.fields.size()];
  const double t = static_cast<double>(random() % 100) / 100;
  switch (random() % 14) {
    case 0:
      field.visible = !field.visible;
      break;
    case 1:
      field.radius = 0.5 + t;
      break;
    case 2:
      field.weight = 0.5 + t;
      break;
    case 3:
      field.support_factor = 1.5 + t;
      break;
    case 4:
      scene.kernel.kernel_scale = 0.5 + t;
      break;
    case 5:
      field.transfer_function = ramp;
      break;
    case 6:
      field.transfer_function = NamedTransferFunction{"magma", {}, {}, {}};
      break;
    case 7:
      field.isosurfaces = {{0.3 + t, ColorBy::element, 0.5 + t / 2}};
      break;
    case 8:
      scene.geometry.assign(random() % 2, {});
      break;
    case 9:
      scene.render.clip_planes.assign(random() % 2, {{0, 0, 1}, t});
      break;
    case 10:
      scene.frame = random() % 4;
      break;  // 3: there is none
    case 11:
      field.select.expression = t < 0.5 ? "x > 0" : "y >";
      break;  // a mistake
    case 12:
      field.radius = "no_such_property";
      break;
    default:
      scene.render.step_size = t < 0.3 ? 1e-12 : 0.3;
      break;  // too small
  }
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr unsigned num_documents = 4;  // what there is to be found is the same in all
#else
constexpr unsigned num_documents = 12;
#endif

TEST_F(DocumentTest, AnyEditsComeToTheSamePictureAsOpeningTheScene) {
  unsigned refused = 0, taken = 0;
  for (unsigned seed = 0; seed < num_documents; ++seed) {
    std::mt19937 random(seed);
    Document document = open(scene());
    for (int i = 0; i < 12; ++i) {
      const Scene before = document.scene();
      const Framebuffer picture_before = picture(document);
      Scene next = before;
      edit(next, random);
      try {
        change(document, next);
        ++taken;
      } catch (const Error&) {
        ++refused;
        EXPECT_EQ(document.scene(), before);
        // (a frame that was moved to and back has another order of sums)
        EXPECT_LT(compare_images(picture(document), picture_before).max, 1e-5);
        continue;
      }
      const Document fresh = open(next);
      EXPECT_EQ(document.scene(), fresh.scene()) << "seed " << seed << " edit " << i;
      EXPECT_LT(compare_images(picture(document), picture(fresh)).max, 1e-4)
          << "seed " << seed << " edit " << i;
    }
  }
  EXPECT_GT(refused, num_documents);
  EXPECT_GT(taken, 4 * num_documents);
}

TEST_F(DocumentTest, DoesTheLeastWork) {
  Document document = open(scene());
  Scene next = document.scene();
  EXPECT_EQ(change(document, next), Change::view);
  next.fields[0].transfer_function = ramp;
  next.fields[0].name = "silicon";
  EXPECT_EQ(change(document, next), Change::view);
  EXPECT_EQ(document.scene().fields[0].name, "silicon");
  next.kernel.kernel_scale = 2;
  EXPECT_EQ(change(document, next), Change::kernels);
  next.frame = 1;
  EXPECT_EQ(change(document, next), Change::frame);
  next.fields[0].radius = 2.0;
  EXPECT_EQ(change(document, next), Change::particles);
  next.data_path = "other.xyz";
  EXPECT_TRUE(document.shows_other_data(next));
  EXPECT_THROW(change(document, next), Error);
}

TEST_F(DocumentTest, TellsOfItsData) {
  Document document = open(scene());
  const DataInfo& info = document.info();
  EXPECT_EQ(info.particles, 60u);
  EXPECT_EQ(info.format, "XYZ");
  ASSERT_EQ(info.species.size(), 2u);
  EXPECT_EQ(info.species[0].name, "Si");
  EXPECT_EQ(info.species[0].count, 20u);
  ASSERT_EQ(info.fields.size(), 2u);
  EXPECT_EQ(info.fields[1].particles, 40u);
  EXPECT_TRUE(info.fields[1].radius);
  EXPECT_FALSE(info.frames);
  EXPECT_EQ(document.count_frames(nullptr), 3u);
  EXPECT_EQ(info.frames, 3u);
  EXPECT_EQ(document.memory().particles, 60u);
}

TEST_F(DocumentTest, SaysWhyThereAreNoSticks) {
  Geometry sticks;
  sticks.type = Geometry::Type::sticks;
  sticks.radius = 0.1;
  Scene some = scene();
  some.geometry = {sticks};
  open(some);
  EXPECT_THAT(warnings_.lines(), IsEmpty());  // among atoms so dense there are bonds
  std::ofstream(path()) << "2\n\nSi 0 0 0\nSi 5 0 0\n";
  open(some);
  EXPECT_THAT(warnings_.lines(), ElementsAre(HasSubstr("none by distance")));
  std::ofstream(path()) << "2\n\nclay 0 0 0\nclay 1 0 0\n";
  open(some);
  EXPECT_THAT(warnings_.lines(),
              ElementsAre(testing::_, HasSubstr("none of the species is a chemical element")));
}

TEST_F(DocumentTest, FramesAreReadAheadOnAnotherThread) {
  Document document = open(scene());
  FrameReader reader = document.frame_reader();
  ParticleSet frame;
  std::thread([&] {
    Warnings warnings;
    frame = reader.read_frame(2, nullptr, warnings);
  }).join();
  EXPECT_EQ(document.set_frame(2, std::move(frame), nullptr, warnings_), Change::frame);
  EXPECT_EQ(document.scene().frame, 2u);
  EXPECT_NEAR(document.particles().bounds().min.x, open(scene()).particles().bounds().min.x + 0.2,
              1e-5);
}

TEST_F(DocumentTest, CanBeCancelled) {
  const Document document = open(scene());
  const std::atomic<bool> cancel = true;
  Framebuffer image;
  EXPECT_THROW(document.render(document.camera(), 33, 33, {}, &cancel, image), Cancelled);
  EXPECT_THROW(document.histogram(document.camera(), 33, 33, &cancel), Cancelled);
  struct : Progress {
    void update(std::string_view, double) override { throw Cancelled(); }
  } impatient;
  EXPECT_THROW(Document::open(path(), scene(), &impatient, warnings_), Cancelled);
}

TEST_F(DocumentTest, PicksTheParticleInTheMiddle) {
  Scene next = scene();
  for (const bool balls : {false, true}) {
    if (!balls) next.geometry.clear();
    if (balls) next.geometry.assign(1, {Geometry::Type::spheres, {}, 0.3});
    const Document document = open(next);
    // The particle nearest to the eye hides all others, seen from where it is in the middle.
    const Document any = open(scene());
    const ParticleSet& particles = any.particles();
    std::size_t first = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (particles.z[i] > particles.z[first]) first = i;
    }
    Camera camera;
    camera.target = particles.position(first);
    camera.eye = camera.target + Vector3d{0, 0, 3};
    const auto pick = document.pick(camera, 33, 33, 16.5, 16.5);
    ASSERT_TRUE(pick) << balls;
    if (balls) {
      EXPECT_EQ(pick->index, first);
    }
    EXPECT_EQ(pick->species, pick->index % 3 == 0 ? "Si" : "O");
    EXPECT_EQ(pick->values.size(), document.scene().fields.size());
    camera.target = camera.eye + Vector3d{0, 0, 3};
    EXPECT_FALSE(document.pick(camera, 33, 33, 16.5, 16.5));
  }
}

TEST_F(DocumentTest, HistogramsCountWhatFieldsTakeInView) {
  Document document = open(scene());
  Scene next = document.scene();
  next.fields[0].visible = false;
  change(document, next);
  const auto all = document.histogram(document.camera(), 33, 33);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_TRUE(all[0].counts.empty());
  std::uint64_t linear = 0, logarithmic = 0;
  for (const auto n : all[1].counts) linear += n;
  for (const auto n : all[1].log_counts) logarithmic += n;
  EXPECT_GT(linear, 0u);
  EXPECT_EQ(linear, logarithmic);  // no value is negative
  EXPECT_GT(all[1].counts.front(), 0u);
  EXPECT_GT(all[1].counts.back(), 0u);
}

}  // namespace
}  // namespace motes
