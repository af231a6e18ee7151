// A data race between sibling tasks, on purpose: the thread sanitizer must report it
// (tests/CMakeLists.txt).
#include <oneapi/tbb/parallel_for.h>

#include <cstdio>

int main() {
  long sum = 0;
  tbb::parallel_for(0, 1'000'000, [&](int i) { sum += i; });
  std::printf("%ld\n", sum);
  return 0;
}
