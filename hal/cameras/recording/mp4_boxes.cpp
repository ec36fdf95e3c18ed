#include "hal/cameras/recording/mp4_boxes.h"

#include <array>
#include <optional>
#include <span>

namespace pleinair::hal::recording {
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
  Scanner(const libav::FileInput& file, std::uint32_t trackId) : file_(file), trackId_(trackId) {}

  Mp4Boxes scan() {
    Mp4Boxes result;
    for (std::int64_t at = 0; at < file_.sizeBytes();) {
      const std::optional<Box> box = boxAt(at);
      if (!budgetLeft()) return {};
      if (!box || box->end > file_.sizeBytes()) {
        result.aborted = true;
        return result;
      }
      if (box->type == fourcc("moof")) result.fragmentSamples += samplesOfMoof(*box);
      at = box->end;
    }
    return result;
  }

 private:
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
    if (at + 8 > file_.sizeBytes()) return std::nullopt;
    std::uint64_t size = number(at, 4);
    Box box{.type = static_cast<std::uint32_t>(number(at + 4, 4)), .payload = at + 8};
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

  std::uint64_t samplesOfMoof(const Box& moof) {
    std::uint64_t samples = 0;
    forEachIn(moof, [&](const Box& traf) {
      if (traf.type != fourcc("traf")) return;
      bool ours = false;
      std::uint64_t inTraf = 0;
      forEachIn(traf, [&](const Box& box) {
        constexpr std::int64_t kVersionAndFlags = 4;
        if (box.end - box.payload < kVersionAndFlags + 4) return;
        const std::uint64_t value = number(box.payload + kVersionAndFlags, 4);
        if (box.type == fourcc("tfhd")) ours = value == trackId_;
        if (box.type == fourcc("trun")) inTraf += value;
      });
      if (ours) samples += inTraf;
    });
    return samples;
  }

  const libav::FileInput& file_;
  std::uint32_t trackId_;
  int boxesRead_ = 0;
};

}  // namespace

Mp4Boxes scanMp4(const libav::FileInput& file, std::uint32_t trackId) {
  return Scanner(file, trackId).scan();
}

}  // namespace pleinair::hal::recording
