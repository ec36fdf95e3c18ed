#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>

#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/gpu/programs/pass_timer.h"

namespace pleinair::bench {

// Common parts of benchmarks of GPU work. Time is wall time, CPU that of all threads.

/// The benchmark's arguments are width and height.
inline hal::FrameSize sizeOf(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
}

/// When the n-th of thirty frames a second was captured.
inline hal::TimePoint timeOfFrame(std::uint64_t number) {
  return hal::TimePoint(hal::Duration(33'333'333) * static_cast<std::int64_t>(number));
}

inline void atBothSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({1280, 720})->Unit(benchmark::kMillisecond)->UseRealTime();
  benchmark->MeasureProcessCPUTime();
}

/// For timePasses().
inline void passAtBothSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({640, 480})->Args({1280, 720})->Unit(benchmark::kMillisecond);
  benchmark->MeasureProcessCPUTime()->UseManualTime()->MinTime(0.2);
}

inline double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return values.empty() ? 0.0 : *middle;
}

inline double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// Some passes out of whole frames, each of which `advance()` makes: the sum of what the timer,
/// which times by fences, says of those whose names begin with one of `passes`.
template <class Advance>
void timePasses(benchmark::State& state, const gpu::PassTimer& timer,
                std::initializer_list<std::string_view> passes, Advance advance) {
  const auto sum = [&] {
    std::chrono::nanoseconds total{0};
    for (const gpu::PassTime& each : timer.times()) {
      for (const std::string_view pass : passes) {
        if (each.pass.starts_with(pass)) total += each.total;
      }
    }
    return total;
  };
  std::vector<double> times;
  for ([[maybe_unused]] auto _ : state) {
    const std::chrono::nanoseconds before = sum();
    advance();
    const double seconds = std::chrono::duration<double>(sum() - before).count();
    state.SetIterationTime(seconds);
    times.push_back(seconds * 1e3);
  }
  state.counters["median_ms"] = medianOf(times);
}

/// Every pass of whole frames, each of which `advance()` makes: medians, ms, as counters. `times()`
/// gives the totals of a timer that times by fences.
template <class Times, class Advance>
void timeEachPass(benchmark::State& state, Times times, Advance advance) {
  std::map<std::string, std::vector<double>> ms;
  std::map<std::string, std::chrono::nanoseconds> before;
  for (const gpu::PassTime& each : times()) before[each.pass] = each.total;
  for ([[maybe_unused]] auto _ : state) {
    advance();
    for (const gpu::PassTime& each : times()) {
      ms[each.pass].push_back(
          std::chrono::duration<double, std::milli>(each.total - before[each.pass]).count());
      before[each.pass] = each.total;
    }
  }
  for (auto& [pass, values] : ms) state.counters[pass] = medianOf(values);
}

}  // namespace pleinair::bench
