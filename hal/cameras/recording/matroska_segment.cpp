#include "hal/cameras/recording/matroska_segment.h"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>

namespace pleinair::hal::recording {
namespace {

struct Element {
  std::uint64_t id = 0;
  std::optional<std::uint64_t> sizeBytes;  ///< size of the element's data; unset: unknown
  std::size_t headerBytes = 0;
};

/// A variable-size integer at the front of `bytes`; its leading zeros give its length.
struct VariableInteger {
  std::uint64_t raw = 0;  ///< with the marker bit, as in an ID
  std::size_t length = 0;
};

std::optional<VariableInteger> variableInteger(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes[0] == 0) return std::nullopt;
  const auto length = static_cast<std::size_t>(std::countl_zero(bytes[0])) + 1;
  if (length > bytes.size()) return std::nullopt;
  VariableInteger value{.length = length};
  for (const std::uint8_t byte : bytes.first(length)) value.raw = value.raw << 8 | byte;
  return value;
}

std::optional<Element> elementAt(const libav::FileInput& file, std::int64_t offset) {
  std::array<std::uint8_t, 16> head{};
  const std::int64_t got = file.readAt(offset, head.data(), head.size());
  if (got <= 0) return std::nullopt;
  const auto bytes = std::span<const std::uint8_t>(head).first(static_cast<std::size_t>(got));
  const auto id = variableInteger(bytes);
  if (!id) return std::nullopt;
  const auto size = variableInteger(bytes.subspan(id->length));
  if (!size) return std::nullopt;
  const std::uint64_t mask = (std::uint64_t{1} << 7 * size->length) - 1;
  const std::uint64_t value = size->raw & mask;
  return Element{.id = id->raw,
                 .sizeBytes = value == mask ? std::nullopt : std::optional(value),
                 .headerBytes = id->length + size->length};
}

}  // namespace

bool segmentBreaksOff(const libav::FileInput& file) {
  constexpr std::uint64_t kSegment = 0x18538067;
  const auto fileBytes = static_cast<std::uint64_t>(file.sizeBytes());
  std::uint64_t at = 0;
  // The EBML header comes first, then possibly a Void, then the Segment.
  for (int i = 0; i < 8 && at < fileBytes; ++i) {
    const std::optional<Element> element = elementAt(file, static_cast<std::int64_t>(at));
    if (!element || !element->sizeBytes) return false;
    const std::uint64_t data = at + element->headerBytes;
    if (data > fileBytes || *element->sizeBytes > fileBytes - data) return true;
    if (element->id == kSegment) return false;
    at = data + *element->sizeBytes;
  }
  return false;
}

}  // namespace pleinair::hal::recording
