// Renders a file of particles with all defaults: render_example FILE PICTURE.png
#include <motes/motes.h>

#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 3) throw motes::Error("usage: render_example FILE PICTURE.png");
  motes::Warnings warnings;
  const motes::ReadOptions options{.warnings = &warnings};
  const motes::ParticleSet particles = motes::open_trajectory(argv[1], options)->read_frame(0);

  // What a scene file would say; empty, everything is fitted to the data.
  const motes::Scene scene;
  const auto fields = motes::expand_fields(scene, particles);
  const auto sources = motes::make_field_sources(particles, fields, scene.kernel, warnings);
  auto geometry = motes::make_geometry_source(particles, scene.geometry, warnings);

  const motes::Renderer renderer(particles, sources, geometry);
  const auto resolved =
      motes::resolve(scene, particles, fields, sources, geometry, renderer.kernels());
  const motes::Framebuffer image = renderer.render(resolved, {});
  motes::write_image(argv[2], image, scene.render.termination_opacity, scene.render.background);

  for (const auto& line : warnings.lines()) std::cerr << line << '\n';
  std::cout << argv[2] << ": " << particles.size() << " particles\n";
  return 0;
} catch (const motes::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
