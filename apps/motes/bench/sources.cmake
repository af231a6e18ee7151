# motes bench.
target_sources(motes PRIVATE
  motes/bench/adaptive_radii.cc
  motes/bench/catalogue.cc
  motes/bench/chart.cc
  motes/bench/command.cc
  motes/bench/cut_out.cc
  motes/bench/grids.cc
  motes/bench/hand.cc
  motes/bench/measure.cc
  motes/bench/particle_file.cc
  motes/bench/peak.cc
  motes/bench/peak_kernels.cc
  motes/bench/recipe_cosmology.cc
  motes/bench/recipe_membrane.cc
  motes/bench/recipe_silica.cc
  motes/bench/recipes_carved.cc
  motes/bench/report.cc
  motes/bench/run_build.cc
  motes/bench/run_fields.cc
  motes/bench/run_fig6.cc
  motes/bench/run_fig7.cc
  motes/bench/run_fig8_fig9.cc
  motes/bench/run_kernels.cc
  motes/bench/run_lattice.cc
  motes/bench/run_limit.cc
  motes/bench/run_quality.cc
  motes/bench/run_radii.cc
  motes/bench/run_scenes.cc
  motes/bench/run_spheres.cc
  motes/bench/run_table1.cc
  motes/bench/run_table2.cc
  motes/bench/run_threads.cc
  motes/bench/run_view.cc
  motes/bench/workplace.cc)
motes_simd_sources(motes/bench/peak_kernels.cc)

# What `motes bench build` and `spheres` compare with, where it is installed.
find_package(embree 3 QUIET)
if(embree_FOUND)
  target_sources(motes PRIVATE motes/bench/embree.cc motes/bench/embree_spheres.cc)
  target_link_libraries(motes PRIVATE embree)
  set_target_properties(motes PROPERTIES MOTES_EMBREE TRUE)  # for its tests
else()
  target_sources(motes PRIVATE motes/bench/embree_missing.cc)
endif()
