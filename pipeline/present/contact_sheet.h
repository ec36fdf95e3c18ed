#pragma once

#include <cstddef>
#include <vector>

#include "hal/clock.h"
#include "hal/image.h"

namespace pleinair::present {

/// An overview of a whole movie: original beside painted, at moments spread evenly over its length,
/// which need not be known in advance. Memory is bounded by the number of moments.
class ContactSheet {
 public:
  explicit ContactSheet(int moments = 6);

  /// Whether to add the frame of this index (counted from 0; ask once for each).
  bool wants(std::size_t frameIndex) const { return frameIndex % stride_ == 0; }

  /// Precondition: wants(frameIndex); both images are RGB8 and of one size.
  void add(const hal::ImageView& original, const hal::ImageView& painted, hal::Duration time);

  bool isEmpty() const { return moments_.empty(); }
  /// RGB8: pairs in reading order, two per row, each with its time. Precondition: not empty.
  hal::Image sheet() const;

 private:
  struct Moment {
    hal::Image original;
    hal::Image painted;
    hal::Duration time{0};
  };
  std::vector<const Moment*> chosen() const;

  std::size_t wanted_;
  std::size_t stride_ = 1;
  std::vector<Moment> moments_;
};

}  // namespace pleinair::present
