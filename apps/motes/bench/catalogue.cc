// The table of scenes.
#include "motes/bench/catalogue.h"

#include <algorithm>

#include "core/error.h"
#include "io/reader.h"
#include "motes/bench/recipes.h"

namespace motes {
namespace {

ParticleSet read(const std::filesystem::path& path) {
  return open_trajectory(path, {})->read_frame(0);
}

ParticleSet membrane(const std::filesystem::path&) { return make_membrane(); }
ParticleSet nanosphere(const std::filesystem::path& data) {
  return make_nanosphere(read(data / "carbon_glass.xyz.xz"), 742'000);
}
ParticleSet silica(const std::filesystem::path& data) {
  return make_fractured_silica(read(data / "sio2_glass.xyz.xz"));
}
ParticleSet nanoparticles(const std::filesystem::path& data) {
  return make_nanoparticles(read(data / "alumina_glass.xyz.xz"), 14'700'000);
}
ParticleSet cosmology(const std::filesystem::path& data) {
  return make_cosmology(read(data / "../demo/cosmo_64.hdf5"), 313);
}

}  // namespace

const std::vector<BenchScene>& bench_scenes() {
  static const std::vector<BenchScene> scenes{
      {"zeolite", 3'494, nullptr, 0, 0.45, {"zeolite", 3494, 0.13, 0.25, 0.16, 0.0256, {}, {}}},
      {"tryptophan", 6'830, membrane, 17, 0.45, {"trypt.", 6830, 0.33, 0.49, 0.339, 0.057, {}, {}}},
      {"nanobowl",
       21'000,
       nullptr,
       0,
       0.5,
       {"nanobowl", 21e3, 0.8, 0.7, 0.5, 0.081, FarClose{3.65, 2.53}, FarClose{9.7, 6.9},
        FarClose{6.15, 4.02}, FarClose{36, 22}, FarClose{2.42, 3.10}, FarClose{41, 32.5}}},
      {"nanosphere_90k",
       92'000,
       nullptr,
       0,
       0.5,
       {"ns.90k", 92e3, 3, 6, 4, 0.91, FarClose{3.8, 4.0}, FarClose{8.8, 10.2},
        FarClose{2.42, 2.97}, FarClose{12.4, 14.8}, FarClose{0.71, 0.65}, FarClose{19.5, 26}}},
      {"nanosphere_740k",
       742'000,
       nanosphere,
       13,
       0.5,
       {"ns.740k", 742e3, 40, 52, 34, 7.5, FarClose{2.93, 3.58}, FarClose{6.25, 7.66},
        FarClose{1.57, 2.46}, FarClose{9.98, 14.1}, FarClose{0.48, 0.31}, FarClose{6, 10.7}}},
      {"sio2",
       4'786'530,
       silica,
       14,
       0.25,
       {"SiO2", 4.8e6, 160, 130, 160, 50, FarClose{2.27, 2.03}, FarClose{6.44, 5.30},
        FarClose{4.51, 2.02}, FarClose{20.3, 10.7}, FarClose{1.03, 0.303}, FarClose{19.6, 20.9}}},
      {"anp3",
       14'699'999,
       nanoparticles,
       15,
       0.35,
       {"ANP3", 14.7e6, 950, 504, 430, 128, FarClose{1.06, 1.07}, FarClose{2.85, 3.91},
        FarClose{0.35, 1.91}, FarClose{1.18, 14.1}, FarClose{0.83, 1.0}, FarClose{2.50, 17.3}}},
      {"cosmology",
       82'051'072,
       cosmology,
       12,
       0.4,
       {"CubeP3M", 82e6, 2624, 3133, 2056, 541, {}, {}}},
  };
  return scenes;
}

std::vector<const BenchScene*> find_bench_scenes(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const BenchScene& scene : bench_scenes()) known.emplace_back(scene.name);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) == known.end()) throw unknown_name("scene", name, known);
  }
  std::vector<const BenchScene*> found;
  for (const BenchScene& scene : bench_scenes()) {
    if (names.empty() || std::ranges::find(names, scene.name) != names.end()) {
      found.push_back(&scene);
    }
  }
  return found;
}

}  // namespace motes
