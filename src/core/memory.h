// How much memory there is to be had.
#pragma once

#include <cstdint>
#include <filesystem>

namespace motes {

/// Bytes that this process may still take without paging or being killed: what the machine has left
/// (MemAvailable of /proc/meminfo), or less where a control group (version 1 or 2) of the process
/// or above it has a limit; what those could give back of their files' cache counts as free. The
/// largest number there is if nothing says. `root` is where /proc and /sys are looked for.
std::uint64_t available_memory(const std::filesystem::path& root = "/");

}  // namespace motes
