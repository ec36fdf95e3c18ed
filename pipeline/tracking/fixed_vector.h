#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace pleinair::tracking {

/// Up to N values in place: what a frame's work makes without allocating.
template <class T, std::size_t N>
class FixedVector {
 public:
  /// Precondition: size() < N.
  void add(const T& value) {
    assert(size_ < N);
    values_[size_++] = value;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return values_.data(); }
  T* end() { return values_.data() + size_; }
  const T* begin() const { return values_.data(); }
  const T* end() const { return values_.data() + size_; }
  const T& operator[](std::size_t index) const {
    assert(index < size_);
    return values_[index];
  }

 private:
  std::array<T, N> values_{};
  std::size_t size_ = 0;
};

}  // namespace pleinair::tracking
