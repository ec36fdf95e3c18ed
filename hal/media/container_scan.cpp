#include "hal/media/container_scan.h"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>

namespace pleinair::hal::libav {
namespace {

constexpr std::uint32_t fourcc(const char (&name)[5]) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(name[i]);
  return value;
}

struct Box {
  std::uint32_t type = 0;
  std::int64_t payload = 0;  ///< its offset in the file
  std::int64_t end = 0;
};

class Scanner {
 public:
  explicit Scanner(const FileInput& file) : file_(file) {}

  Mp4Boxes scan(std::uint32_t trackId) {
    Mp4Boxes result;
    const Last last = forEachBox([&](const Box& box) {
      if (box.type == fourcc("moof")) result.fragmentSamples += samplesOfMoof(box, trackId);
    });
    if (!budgetLeft()) return {};
    result.aborted = last.at < file_.sizeBytes();
    return result;
  }

  std::int64_t readableBytes() {
    const Last last = forEachBox([](const Box&) {});
    const bool isCut = file_.sizeBytes() - last.at < kHeadBytes ||
                       (last.type == fourcc("moof") && isCutHead(last.at));
    return isCut && last.at > 0 ? last.at : file_.sizeBytes();
  }

 private:
  /// The first box that is not whole, or the end of the file.
  struct Last {
    std::int64_t at = 0;
    std::uint32_t type = 0;  ///< 0 at the end of the file, or where the size is invalid
  };

  /// Calls visit(box) for each whole box of the file.
  template <class Visitor>
  Last forEachBox(Visitor visit) {
    std::int64_t at = 0;
    while (at < file_.sizeBytes() && budgetLeft()) {
      const std::optional<Box> box = boxAt(at);
      if (!box) return {.at = at};
      if (box->end > file_.sizeBytes()) return {.at = at, .type = box->type};
      visit(*box);
      at = box->end;
    }
    return {.at = at};
  }

  /// Whether a head that is not whole ends with the file. Otherwise its size is damaged: its data
  /// (mdat) follows, and libav reads it.
  bool isCutHead(std::int64_t at) {
    std::int64_t next = at + kHeadBytes;
    while (file_.sizeBytes() - next >= kHeadBytes && budgetLeft()) {
      const std::optional<Box> child = boxAt(next);
      if (!child || child->type == fourcc("mdat")) return false;
      next = child->end;
    }
    return true;
  }

  static constexpr std::int64_t kHeadBytes = 8;  ///< size and type
  static constexpr int kMaxBoxes = 1'000'000;
  bool budgetLeft() const { return boxesRead_ < kMaxBoxes; }

  std::uint64_t number(std::int64_t offset, std::size_t bytes) const {
    std::array<std::uint8_t, 8> raw{};
    file_.readAt(offset, raw.data(), bytes);
    std::uint64_t value = 0;
    for (const std::uint8_t byte : std::span(raw).first(bytes)) value = value << 8 | byte;
    return value;
  }

  std::optional<Box> boxAt(std::int64_t at) {
    ++boxesRead_;
    if (at + kHeadBytes > file_.sizeBytes()) return std::nullopt;
    std::uint64_t size = number(at, 4);
    Box box{.type = static_cast<std::uint32_t>(number(at + 4, 4)), .payload = at + kHeadBytes};
    if (size == 1) {
      size = number(at + 8, 8);
      box.payload = at + 16;
    } else if (size == 0) {  // the box extends to the end of the file
      size = static_cast<std::uint64_t>(file_.sizeBytes() - at);
    }
    constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 62;
    if (size < static_cast<std::uint64_t>(box.payload - at) || size > kLargestFile) {
      return std::nullopt;
    }
    box.end = at + static_cast<std::int64_t>(size);
    return box;
  }

  /// Calls visit(box) for each whole box inside `parent`.
  template <class Visitor>
  void forEachIn(const Box& parent, Visitor visit) {
    std::int64_t at = parent.payload;
    while (at < parent.end && budgetLeft()) {
      const std::optional<Box> box = boxAt(at);
      if (!box || box->end > parent.end) return;
      visit(*box);
      at = box->end;
    }
  }

  std::uint64_t samplesOfMoof(const Box& moof, std::uint32_t trackId) {
    std::uint64_t samples = 0;
    forEachIn(moof, [&](const Box& traf) {
      if (traf.type != fourcc("traf")) return;
      bool ours = false;
      std::uint64_t inTraf = 0;
      forEachIn(traf, [&](const Box& box) {
        constexpr std::int64_t kVersionAndFlags = 4;
        if (box.end - box.payload < kVersionAndFlags + 4) return;
        const std::uint64_t value = number(box.payload + kVersionAndFlags, 4);
        if (box.type == fourcc("tfhd")) ours = value == trackId;
        if (box.type == fourcc("trun")) inTraf += value;
      });
      if (ours) samples += inTraf;
    });
    return samples;
  }

  const FileInput& file_;
  int boxesRead_ = 0;
};

}  // namespace

Mp4Boxes scanMp4(const FileInput& file, std::uint32_t trackId) {
  return Scanner(file).scan(trackId);
}

std::int64_t readableMp4Bytes(const FileInput& file) {
  return Scanner(file).readableBytes();
}

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

std::optional<Element> elementAt(const FileInput& file, std::int64_t offset) {
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

bool segmentBreaksOff(const FileInput& file) {
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

}  // namespace pleinair::hal::libav
