#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace pleinair::fuzz {

/// Takes an input apart into values; where it ends, into zeros.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  bool isEmpty() const { return rest_.empty(); }

  template <std::integral T>
  T number() {
    T value = 0;
    const std::size_t length = std::min(rest_.size(), sizeof value);
    if (length > 0) std::memcpy(&value, rest_.data(), length);
    rest_ = rest_.subspan(length);
    return value;
  }
  /// 0 to `count` − 1.
  std::size_t upTo(std::size_t count) { return number<std::uint8_t>() % count; }
  /// Whether the next byte says so: once in `times`.
  bool once(std::size_t times) { return number<std::uint8_t>() % times == times - 1; }
  template <class T>
  T oneOf(std::initializer_list<T> values) {
    return *(values.begin() + upTo(values.size()));
  }
  std::vector<std::uint8_t> bytes(std::size_t most) {
    const std::size_t length = std::min(rest_.size(), most);
    const std::vector<std::uint8_t> taken(rest_.begin(), rest_.begin() + static_cast<long>(length));
    rest_ = rest_.subspan(length);
    return taken;
  }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace pleinair::fuzz
