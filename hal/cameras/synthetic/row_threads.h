#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace pleinair::hal::synthetic {

/// Runs work(first, end) on shares of the rows [begin, end), a processor each, and returns when all
/// are done. The shares must not touch each other's rows; `work` must not throw.
template <class Work>
void forRows(int begin, int end, const Work& work) {
  constexpr int kFewestRows = 64;
  constexpr int kMostThreads = 8;
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int shares = std::min({processors, kMostThreads, (end - begin) / kFewestRows});
  if (shares <= 1) return work(begin, end);
  std::vector<std::jthread> threads;
  const int step = (end - begin + shares - 1) / shares;
  for (int first = begin; first < end; first += step) {
    threads.emplace_back([&work, first, last = std::min(end, first + step)] { work(first, last); });
  }
}

}  // namespace pleinair::hal::synthetic
