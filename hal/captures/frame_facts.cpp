#include "hal/captures/frame_facts.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

namespace pleinair::hal::captures {
namespace {

constexpr std::int64_t kHundredYears = 3'155'760'000'000'000'000;
constexpr std::array<std::string_view, 5> kSources{"exposure", "readout", "arrival", "recording",
                                                   "simulated"};
constexpr std::array<std::string_view, 3> kHealths{"valid", "corrupt", "incomplete"};

template <class T>
bool readNumber(std::string_view text, T& number) {
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  return status == std::errc() && end == text.data() + text.size();
}

template <class E, std::size_t N>
bool readWord(std::string_view text, const std::array<std::string_view, N>& words, E& value) {
  const auto found = std::ranges::find(words, text);
  if (found == words.end()) return false;
  value = static_cast<E>(found - words.begin());
  return true;
}

bool isPlausible(std::int64_t time) {
  return time >= -kHundredYears && time <= kHundredYears;
}

/// Whether the value is valid, or the word unknown.
bool read(std::string_view word, std::string_view value, FrameFacts& facts, bool& hasTime) {
  std::int64_t time = 0;
  if (word == "time" || word == "device") {
    if (!readNumber(value, time) || !isPlausible(time)) return false;
    if (word == "device") {
      facts.deviceTime = Duration(time);
    } else {
      facts.time = Duration(time);
      hasTime = true;
    }
    return true;
  }
  if (word == "dropped") return readNumber(value, facts.droppedBefore);
  if (word == "underruns") return readNumber(value, facts.underrunsBefore);
  if (word == "missing") return readNumber(value, facts.linkBefore.missingPackets);
  if (word == "resent") return readNumber(value, facts.linkBefore.resentPackets);
  if (word == "ignored") return readNumber(value, facts.linkBefore.ignoredPackets);
  if (word == "source") return readWord(value, kSources, facts.timestampSource);
  if (word == "health") return readWord(value, kHealths, facts.health);
  return true;
}

}  // namespace

FrameFacts factsOf(const CapturedFrame& frame, TimePoint start) {
  return {.time = frame.captureTime - start,
          .droppedBefore = frame.droppedBefore,
          .underrunsBefore = frame.underrunsBefore,
          .linkBefore = frame.linkBefore,
          .timestampSource = frame.timestampSource,
          .deviceTime = frame.deviceTime,
          .health = frame.health};
}

std::string textOf(const FrameFacts& facts) {
  std::string text = fmt::format("time={}", facts.time.count());
  const auto add = [&](std::string_view word, std::uint64_t number) {
    if (number > 0) text += fmt::format(" {}={}", word, number);
  };
  add("dropped", facts.droppedBefore);
  add("underruns", facts.underrunsBefore);
  add("missing", facts.linkBefore.missingPackets);
  add("resent", facts.linkBefore.resentPackets);
  add("ignored", facts.linkBefore.ignoredPackets);
  if (facts.deviceTime) text += fmt::format(" device={}", facts.deviceTime->count());
  return text + fmt::format(" source={} health={}",
                            kSources.at(static_cast<std::size_t>(facts.timestampSource)),
                            kHealths.at(static_cast<std::size_t>(facts.health)));
}

std::optional<FrameFacts> parseFacts(std::string_view text) {
  FrameFacts facts;
  bool hasTime = false;
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(pair.size() + 1, text.size()));
    const std::size_t sign = pair.find('=');
    if (sign == std::string_view::npos) continue;
    if (!read(pair.substr(0, sign), pair.substr(sign + 1), facts, hasTime)) return std::nullopt;
  }
  return hasTime ? std::optional(facts) : std::nullopt;
}

}  // namespace pleinair::hal::captures
