// Reads with the console, and finds whose mistake an error is.
#include "motes/input.h"

#include <fmt/format.h>

#include <algorithm>

namespace motes {

Input read_input(const Scene& scene, Console& console) {
  Input input = read_input(scene, &console, console.warnings());
  console.print_warnings();
  return input;
}

Input read_particles(const Scene& scene, Console& console) {
  Input input = read_particles(scene, &console, console.warnings());
  console.print_warnings();
  return input;
}

void fail_in_place(const std::string& message, const std::filesystem::path& path,
                   const SceneChanges& changes) {
  // The option of "fields[0].radius" is --radius, that of "render.step_size" --step-size.
  const auto end = message.find_first_not_of("abcdefghijklmnopqrstuvwxyz_.[]0123456789");
  if (end != message.npos && message.compare(end, 2, ": ") == 0) {
    const std::string key = message.substr(0, end);
    std::string option = "--" + key.substr(key.rfind('.') + 1);
    std::replace(option.begin(), option.end(), '_', '-');
    if (changes.contains(option)) {
      throw Error(fmt::format("{}: {}", option, message.substr(end + 2)));
    }
  }
  throw Error(path, message);
}

}  // namespace motes
