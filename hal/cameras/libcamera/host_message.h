#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hal/cameras/libcamera/library.h"

// Messages between the program and the process that hosts libcamera (host_server.h): the values of
// the seam (library.h), field by field. What a reader takes is checked, because the host has code
// of drivers and of libcamera in it: numbers of enumerations, counts, lengths.

namespace pleinair::hal::libcamera {

/// What the program asks of the host. Each is answered by a Result.
enum class Call : std::uint8_t {
  kList,
  kOpen,
  kDescription,
  kFormats,
  kConfigure,
  kRange,
  kHasAutomatic,
  kPeriods,
  kStart,
  kStop,
};
inline constexpr auto kLastCall = Call::kStop;

/// What goes over the channel of frames: to the program all but the first.
enum class FrameNote : std::uint8_t { kPush, kCompleted, kPushFailed, kLost };
inline constexpr auto kLastNote = FrameNote::kLost;

/// A plane of a buffer, in one of the descriptors that come with the message.
struct SharedPlane {
  std::uint32_t descriptor = 0;
  std::uint64_t offset = 0, length = 0;
};
/// The planes of each buffer.
using SharedBuffers = std::vector<std::vector<SharedPlane>>;
/// The buffers of a stream's frames, and those of their second images: as many, or none.
struct SharedStream {
  SharedBuffers frames, luma;
};

/// Longest message, in bytes.
inline constexpr std::size_t kLongestMessage = 64 * 1024;

class MessageWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put(T value) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
  }
  void put(std::string_view text);
  void put(Duration time) { put(static_cast<std::int64_t>(time.count())); }
  void put(const FrameSize& size);
  void put(const Error& error);
  void put(const FoundCamera& camera);
  void put(const OfferedFormat& format);
  void put(const StreamWish& wish);
  void put(const StreamAnswer& answer);
  void put(const ControlRange& range);
  void put(const StartSettings& settings);
  void put(const Completed& completed);
  void put(const StreamImage& image);
  void put(const SharedPlane& plane);
  void put(const SharedStream& stream);
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    for (const T& each : values) put(each);
  }
  template <class T>
  void put(const Result<T>& result) {
    put(result.has_value());
    if (!result) put(result.error());
    if constexpr (!std::is_void_v<T>) {
      if (result) put(*result);
    }
  }

  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Takes values in the order in which they were put. After one that is not there or not valid, all
/// are empty, and isValid() is false.
class MessageReader {
 public:
  explicit MessageReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  bool isValid() const { return isValid_; }

  template <class T>
  requires(std::is_arithmetic_v<T> && !std::same_as<T, bool>) void take(T& value) {
    value = {};
    if (!isValid_ || rest_.size() < sizeof value) return fail();
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_ = rest_.subspan(sizeof value);
  }
  /// A value up to `last`.
  template <class T>
  requires std::is_enum_v<T>
  void take(T& value, T last) {
    std::underlying_type_t<T> number{};
    take(number);
    value = {};
    if (number < 0 || number > static_cast<std::underlying_type_t<T>>(last)) return fail();
    value = static_cast<T>(number);
  }
  void take(bool& value);
  void take(std::string& text);
  void take(Duration& time);
  void take(FrameSize& size);
  void take(Error& error);
  void take(FoundCamera& camera);
  void take(OfferedFormat& format);
  void take(StreamWish& wish);
  void take(StreamAnswer& answer);
  void take(ControlRange& range);
  void take(StartSettings& settings);
  void take(Completed& completed);
  void take(StreamImage& image);
  void take(SharedPlane& plane);
  void take(SharedStream& stream);
  template <class T>
  void take(std::optional<T>& value) {
    bool isThere = false;
    take(isThere);
    value.reset();
    if (!isThere) return;
    take(value.emplace());
    if (!isValid_) value.reset();
  }
  template <class T>
  void take(std::vector<T>& values) {
    std::uint32_t count = 0;
    take(count);
    values.clear();
    for (std::uint32_t i = 0; i < count && isValid_; ++i) take(values.emplace_back());
    if (!isValid_) values.clear();
  }

 private:
  void fail() {
    isValid_ = false;
    rest_ = {};
  }

  std::span<const std::uint8_t> rest_;
  bool isValid_ = true;
};

}  // namespace pleinair::hal::libcamera
