#include "pipeline/tracking/pose/tag_family.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/tracking/pose/tag_detector.h"

namespace pleinair::tracking {
namespace {

struct FamilyEntry {
  std::string_view name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
  /// The library tabulates each code with up to this many flipped bits: two take 36 MB for
  /// tag36h11's 587 codes, but gigabytes for tagStandard52h13's 48,714.
  int correctedBits;
};

constexpr std::array<FamilyEntry, 9> kFamilies{{
    {"tag36h11", tag36h11_create, tag36h11_destroy, 2},
    {"tag36h10", tag36h10_create, tag36h10_destroy, 1},
    {"tag25h9", tag25h9_create, tag25h9_destroy, 2},
    {"tag16h5", tag16h5_create, tag16h5_destroy, 2},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy, 2},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy, 1},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy, 1},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy, 1},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy, 1},
}};

const FamilyEntry* findFamily(std::string_view name) {
  const auto* found = std::ranges::find(kFamilies, name, &FamilyEntry::name);
  return found == kFamilies.end() ? nullptr : found;
}

const FamilyEntry& familyOrThrow(std::string_view name) {
  hal::orThrow(checkTagFamily(name));
  return *findFamily(name);
}

}  // namespace

hal::Result<void> checkTagFamily(std::string_view family, std::string subject) {
  if (findFamily(family) != nullptr) return {};
  std::vector<std::string_view> names;
  names.reserve(kFamilies.size());
  for (const FamilyEntry& entry : kFamilies) names.push_back(entry.name);
  return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                   .subject = std::move(subject),
                                   .problem = fmt::format("unknown tag family '{}'", family),
                                   .remedy = fmt::format("use one of {}", fmt::join(names, ", "))});
}

TagFamily openTagFamily(std::string_view name) {
  const FamilyEntry& entry = familyOrThrow(name);
  return {.handle = {entry.create(), entry.destroy}, .correctedBits = entry.correctedBits};
}

TagBitmap tagBitmap(std::string_view family, int id) {
  const TagFamily opened = openTagFamily(family);
  const apriltag_family_t& codes = *opened.handle;
  if (id < 0 || static_cast<std::uint32_t>(id) >= codes.ncodes) {
    throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                  .subject = fmt::format("tag {}", id),
                                  .problem = fmt::format("is not in {}", family),
                                  .remedy = fmt::format("give 0 to {}", codes.ncodes - 1)});
  }
  TagBitmap bitmap{.cells = codes.total_width, .edgeCells = codes.width_at_border};
  const auto cells = static_cast<std::size_t>(bitmap.cells);
  bitmap.isWhite.assign(cells * cells, false);
  const auto paint = [&](int row, int column) {
    bitmap.isWhite.at(static_cast<std::size_t>(row) * cells + static_cast<std::size_t>(column)) =
        true;
  };
  // One cell of white around the edge, or within it where the family's border is reversed.
  const int whiteSide = codes.width_at_border + (codes.reversed_border ? 0 : 2);
  const int first = (bitmap.cells - whiteSide) / 2;
  const int last = bitmap.cells - 1 - first;
  for (int i = first; i <= last; ++i) {
    paint(first, i);
    paint(last, i);
    paint(i, first);
    paint(i, last);
  }
  const int border = (bitmap.cells - codes.width_at_border) / 2;
  for (std::uint32_t bit = 0; bit < codes.nbits; ++bit) {
    const bool isSet = (codes.codes[id] >> (codes.nbits - bit - 1) & 1U) != 0;
    if (isSet) {
      paint(static_cast<int>(codes.bit_y[bit]) + border,
            static_cast<int>(codes.bit_x[bit]) + border);
    }
  }
  return bitmap;
}

}  // namespace pleinair::tracking
