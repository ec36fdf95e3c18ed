#include "pipeline/runtime/frame_log.h"

#include <utility>

namespace pleinair::runtime {

void FrameLog::add(const FrameRecord& record) {
  const std::scoped_lock lock(mutex_);
  if (records_.size() == kCapacity) {
    ++lost_;
    return;
  }
  records_.push_back(record);
}

std::uint64_t FrameLog::take(std::vector<FrameRecord>& records) {
  records.clear();
  records.reserve(kCapacity);
  const std::scoped_lock lock(mutex_);
  records_.swap(records);
  return std::exchange(lost_, 0);
}

}  // namespace pleinair::runtime
