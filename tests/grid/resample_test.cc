// Grids of particles' fields against the reference, sample by sample.
#include "grid/resample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "grid/instruction_sets.h"
#include "reference/field.h"
#include "support/particles_at.h"
#include "support/random_scene.h"

namespace motes {
namespace {

/// The reference at a sample.
struct Truth {
  reference::FieldValue field;
  /// Sum of the peaks of kernels that end smoothly: close to their ends they are small differences
  /// of such numbers, good to some units of their last place. Of tables twice: in rough ones a
  /// distance's last place shows.
  double peaks = 0;
};

Truth truth_at(const std::vector<reference::ParticleKernel>& kernels, const Point3d& x) {
  Truth truth{reference::evaluate_field(kernels, x)};
  for (const reference::ParticleKernel& kernel : kernels) {
    if (kernel.shape->type == KernelType::gaussian) continue;
    if (length(x - kernel.center) <= kernel.support_radius) {
      const bool is_table = kernel.shape->type == KernelType::tabulated;
      truth.peaks += (is_table ? 2 : 1) * std::abs(kernel.amplitude);
    }
  }
  return truth;
}

/// Samples of every field on every instruction set; returns how many were in some support.
int expect_truth(const ParticleSet& particles, const std::vector<FieldSource>& fields,
                 const Lattice& lattice, int stride) {
  const KernelSet kernels = build_kernel_set(particles, fields);
  int checked = 0;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto truth_kernels = reference::particle_kernels(particles, fields[f]);
    double smallest = std::numeric_limits<double>::infinity();
    for (const auto& kernel : truth_kernels) smallest = std::min(smallest, kernel.radius);
    std::vector<std::pair<std::size_t, Truth>> expected;
    const std::size_t size = lattice.dims[0] * lattice.dims[1] * lattice.dims[2];
    for (std::size_t n = 0; n < size; n += static_cast<std::size_t>(stride)) {
      const std::size_t i = n % lattice.dims[0], j = n / lattice.dims[0] % lattice.dims[1];
      const std::size_t k = n / lattice.dims[0] / lattice.dims[1];
      const Point3d x{lattice.origin.x + double(i) * lattice.step.x,
                      lattice.origin.y + double(j) * lattice.step.y,
                      lattice.origin.z + double(k) * lattice.step.z};
      const Truth truth = truth_at(truth_kernels, x);
      // Coordinates of particles are floats relative to their origin, as the reference has them;
      // only on a jump itself a rounding decides.
      if (truth.field.boundary_distance <= 1e-6 * smallest) continue;
      expected.emplace_back(n, truth);
    }
    on_all_instruction_sets([&] {
      const std::vector<Grid> grids = resample(kernels, lattice);
      ASSERT_EQ(grids.size(), fields.size());
      EXPECT_EQ(grids[f].name, fields[f].name);
      EXPECT_EQ(grids[f].dims, lattice.dims);
      for (const auto& [n, truth] : expected) {
        // As of the engines' samples: a few roundings of distances and exponents.
        ASSERT_NEAR(grids[f].values[n], truth.field.value,
                    5e-6 * truth.field.absolute + 3e-6 * truth.peaks)
            << "field " << f << ", sample " << n;
        checked += truth.field.num_kernels > 0 ? 1 : 0;
      }
    });
  }
  return checked;
}

TEST(Resample, IsTheReferenceForRandomScenes) {
  int checked = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    RandomScene random = random_scene(seed);
    SCOPED_TRACE(random.description);
    for (FieldSource& field : random.scene.fields) {
      // Densities of a cluster in centimetres are nothing for floats.
      if (field.normalise) field.kernel.kernel_scale *= std::pow(double(field.radius[0]), 3);
    }
    const Bounds3d box = build_kernel_set(random.particles, random.scene.fields).box();
    const Vector3d extent = box.diagonal();
    const double longest = std::max({extent.x, extent.y, extent.z});
    const Lattice lattice = seed % 3 == 0 ? lattice_of_counts(box, {13, 7 + seed % 30, 19})
                                          : lattice_of_size(box, longest / (3 + seed % 40));
    checked += expect_truth(random.particles, random.scene.fields, lattice, 97);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(checked, 3000 * static_cast<int>(instruction_sets().size()));
}

ParticleSet random_particles(int count, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, size);
  std::vector<Point3d> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    points.push_back({1e6 + place(random), place(random), place(random)});
  }
  return particles_at(points);
}

FieldSource field_of(const ParticleSet& particles, const Kernel& kernel, float radius) {
  FieldSource source;
  source.name = "a";
  source.kernel = kernel;
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    source.index.push_back(i);
    source.weight.push_back(i % 4 == 0 ? -1.5f : 1);
  }
  source.radius = {radius};
  return source;
}

// Several bricks, kernels from less than a voxel to more than a brick, each shape.
TEST(Resample, IsTheReferenceAcrossBricks) {
  const ParticleSet particles = random_particles(300, 10, 1);
  for (int type = 0; type < 7; ++type) {
    Kernel kernel;
    kernel.shape.type = static_cast<KernelType>(type);
    if (kernel.shape.type == KernelType::tabulated) kernel.shape.profile.values = {1, 0.3, 0.2};
    for (const float radius : {0.05f, 0.4f, 4.f}) {
      const FieldSource field = field_of(particles, kernel, radius);
      const Bounds3d box = build_kernel_set(particles, {field}).box();
      const Lattice lattice = lattice_of_counts(box, {47, 71, 33});
      const int checked = expect_truth(particles, {field}, lattice, radius < 0.1f ? 17 : 97);
      EXPECT_GT(checked, (radius < 0.1f ? 3 : 300) * static_cast<int>(instruction_sets().size()));
      if (HasFatalFailure()) return;
    }
  }
}

// Tables in every form that the engines take them in: polynomials in the squared distance and in
// the distance, steps in registers and in memory.
TEST(Resample, IsTheReferenceForEveryFormOfTables) {
  const ParticleSet particles = random_particles(300, 10, 3);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> noise(0.9, 1);
  const auto bell = [](double q) { return std::exp(-4 * q * q); };
  const auto cube = [](double q) { return 1 - 3 * q * q + 2 * q * q * q; };
  const auto noisy = [&](double q) { return noise(random) * bell(q); };
  const auto check = [&](int steps, auto&& value) {
    Kernel kernel;
    kernel.shape.type = KernelType::tabulated;
    kernel.shape.profile.spacing = 2.5 / steps;
    for (int i = 0; i <= steps; ++i)
      kernel.shape.profile.values.push_back(value(double(i) / steps));
    const FieldSource field = field_of(particles, kernel, 0.4f);
    const Bounds3d box = build_kernel_set(particles, {field}).box();
    const int checked = expect_truth(particles, {field}, lattice_of_counts(box, {47, 71, 33}), 31);
    EXPECT_GT(checked, 300 * static_cast<int>(instruction_sets().size()));
  };
  check(256, bell);
  check(2000, cube);
  for (const int steps : {20, 32, 33, 50, 64, 65, 256}) {
    SCOPED_TRACE(steps);
    check(steps, noisy);
  }
}

// A lattice so large that its bricks are the larger ones, with a few particles.
TEST(Resample, IsTheReferenceOnALargeLattice) {
  const ParticleSet particles = random_particles(20, 10, 2);
  const FieldSource field = field_of(particles, {}, 0.3f);
  const Bounds3d box = build_kernel_set(particles, {field}).box();
  EXPECT_GT(expect_truth(particles, {field}, lattice_of_counts(box, {300, 301, 190}), 1009), 10);
}

// Samples may lie anywhere: the lattice needs not to cover the particles.
TEST(Resample, IsZeroBeyondAllSupports) {
  const ParticleSet particles = random_particles(50, 10, 3);
  const FieldSource field = field_of(particles, {}, 0.3f);
  const KernelSet kernels = build_kernel_set(particles, {field});
  const auto grids = resample(kernels, {{0, 0, 0}, {1, 1, 1}, {20, 21, 22}});
  for (const float value : grids[0].values) EXPECT_EQ(value, 0);
}

TEST(Resample, IsTheSameWithAnyNumberOfThreads) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const RandomScene random = random_scene(seed);
    const KernelSet kernels = build_kernel_set(random.particles, random.scene.fields);
    const Lattice lattice = lattice_of_counts(kernels.box(), {65, 70, 75});
    const auto with_threads = [&](int threads) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 8);
      tbb::task_arena arena(threads);
      return arena.execute([&] { return resample(kernels, lattice); });
    };
    const std::vector<Grid> one = with_threads(1);
    for (const int threads : {2, 7}) {
      const std::vector<Grid> more = with_threads(threads);
      for (std::size_t f = 0; f < one.size(); ++f) {
        EXPECT_TRUE(one[f].values == more[f].values) << random.description;
      }
    }
  }
}

TEST(Resample, RefusesValuesThatFloatsDoNotHold) {
  const ParticleSet particles = random_particles(5, 10, 3);
  FieldSource field = field_of(particles, {}, 1);
  for (const double scale : {1e-40, 1e36}) {
    field.kernel.kernel_scale = scale;
    const KernelSet kernels = build_kernel_set(particles, {field});
    try {
      resample(kernels, lattice_of_size(kernels.box(), 1));
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("field 'a' has values around "));
    }
  }
}

TEST(Resample, ReportsProgressToItsEnd) {
  struct LastFraction : Progress {
    void update(std::string_view, double f) override {
      EXPECT_GT(f, fraction);
      fraction = f;
    }
    double fraction = 0;
  } progress;
  const ParticleSet particles = random_particles(5, 10, 3);
  const KernelSet kernels = build_kernel_set(particles, {field_of(particles, {}, 1)});
  resample(kernels, lattice_of_counts(kernels.box(), {40, 40, 40}), &progress);
  EXPECT_EQ(progress.fraction, 1);
}

}  // namespace
}  // namespace motes
