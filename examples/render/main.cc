// Opens a file of particles and says what is in it: render_example FILE
#include <motes/motes.h>

#include <iostream>

int main(int argc, char** argv) try {
  const motes::ReadOptions options;
  const auto trajectory = motes::open_trajectory(argc > 1 ? argv[1] : "", options);
  const motes::ParticleSet particles = trajectory->read_frame(0);
  std::cout << trajectory->format() << ": " << particles.size() << " particles\n";
  return 0;
} catch (const motes::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
