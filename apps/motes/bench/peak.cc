// Runs loops on all threads at once and takes their best times.
#include "motes/bench/peak.h"

#include <tbb/info.h>
#include <unistd.h>
#include <x86intrin.h>

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

#include "core/aligned.h"
#include "motes/bench/peak_kernels.h"
#include "motes/bench/random.h"

namespace motes {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

/// Seconds from the first thread's start of work(thread) to the last one's end. Each thread reads
/// the clock itself: one that starts late, because the machine has other work, must not make the
/// others look faster.
template <class Work>
double seconds_of_all(int threads, const Work& work) {
  std::vector<Clock::time_point> begin(static_cast<std::size_t>(threads)), end = begin;
  {
    std::barrier start(threads);
    std::vector<std::jthread> workers;
    for (std::size_t t = 0; t < begin.size(); ++t) {
      workers.emplace_back([&, t] {
        start.arrive_and_wait();
        begin[t] = Clock::now();
        work(t);
        end[t] = Clock::now();
      });
    }
  }
  return seconds(*std::ranges::max_element(end) - *std::ranges::min_element(begin));
}

/// Entries as a molecular scene has them: half of their evaluations are inside of the support.
std::vector<PeakEntry> make_entries() {
  constexpr std::size_t count = 32;  // 6 KiB: they stay in the nearest cache
  const Random random(1);
  std::uint64_t next = 0;
  std::vector<PeakEntry> entries(count);
  for (PeakEntry& entry : entries) {
    for (float* values : {entry.column, entry.slope_x}) {
      for (int i = 0; i < PeakEntry::columns; ++i) {
        values[i] = static_cast<float>(random.uniform(next++));
      }
    }
    for (float* values : {entry.row, entry.slope_y}) {
      for (int i = 0; i < PeakEntry::rows; ++i) {
        values[i] = static_cast<float>(random.uniform(next++));
      }
    }
    entry.cut = 0.19F;  // half of the products of two uniform numbers
    entry.slope_z = static_cast<float>(random.uniform(next++));
  }
  return entries;
}

/// Kernel evaluations a second of all threads, the best of several runs.
double evaluation_peak(int threads, bool lit) {
  constexpr int runs = 50;
  constexpr double run_seconds = 0.008;  // short: some then meet no other work of the machine
  const std::vector<PeakEntry> entries = make_entries();
  std::vector<float> totals(static_cast<std::size_t>(threads));
  std::uint64_t evaluations = 0;  // of each thread
  std::size_t rounds = 1000;
  const auto run = [&] {
    return seconds_of_all(threads, [&](std::size_t t) {
      float total = 0;
      const std::uint64_t done = add_entries(entries, lit, rounds, total);
      totals[t] = total;
      if (t == 0) evaluations = done;
    });
  };
  const double trial = std::min(run(), run());  // the first one warms up
  rounds = static_cast<std::size_t>(static_cast<double>(rounds) * run_seconds / trial) + 1;
  double best = 0;
  for (int i = 0; i < runs; ++i) {
    const double time = run();
    best = std::max(best, static_cast<double>(evaluations) * threads / time);
  }
  return best;
}

/// Much larger than the caches, and no more than an eighth of the memory.
std::size_t large_array_bytes(std::size_t memory) {
  const long cache = ::sysconf(_SC_LEVEL3_CACHE_SIZE);
  constexpr std::size_t least = 1U << 28U, most = 1U << 30U;
  const std::size_t wanted =
      std::clamp(8 * static_cast<std::size_t>(std::max(cache, 0L)), least, most);
  return std::min(wanted, memory / 8);
}

void measure_memory(int threads, std::size_t memory, MachinePeak& peak) {
  constexpr int runs = 6;
  constexpr std::size_t unit = 64;  // floats that sum_of() takes at once
  const auto num_threads = static_cast<std::size_t>(threads);
  const std::size_t part =
      std::max<std::size_t>(large_array_bytes(memory) / sizeof(float) / num_threads / unit, 1) *
      unit;
  UninitializedVector<float> from(part * num_threads), to(part * num_threads);
  std::vector<float> totals(num_threads);
  seconds_of_all(threads, [&](std::size_t t) {  // each touches its own part first
    std::fill_n(from.data() + t * part, part, 1.0F);
    std::fill_n(to.data() + t * part, part, 0.0F);
  });
  peak.array_bytes = from.size() * sizeof(float);
  const auto bytes = static_cast<double>(peak.array_bytes);
  for (int i = 0; i < runs; ++i) {
    const double reading = seconds_of_all(
        threads, [&](std::size_t t) { totals[t] = sum_of(from.data() + t * part, part); });
    const double copying = seconds_of_all(threads, [&](std::size_t t) {
      std::memcpy(to.data() + t * part, from.data() + t * part, part * sizeof(float));
    });
    peak.read = std::max(peak.read, bytes / reading);
    peak.copied = std::max(peak.copied, 2 * bytes / copying);
  }
}

}  // namespace

MachinePeak measure_peak(int threads, std::size_t memory) {
  MachinePeak peak;
  peak.threads = threads > 0 ? threads : tbb::info::default_concurrency();
  peak.lanes = num_peak_lanes();
  const Clock::time_point begin = Clock::now();
  const std::uint64_t first_tick = __rdtsc();
  peak.unlit = evaluation_peak(peak.threads, false);
  peak.lit = evaluation_peak(peak.threads, true);
  measure_memory(peak.threads, memory, peak);
  const std::uint64_t last_tick = __rdtsc();
  peak.ticks = static_cast<double>(last_tick - first_tick) / seconds(Clock::now() - begin);
  return peak;
}

}  // namespace motes
