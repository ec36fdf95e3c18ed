#pragma once

#include <string>

#include "hal/image.h"

namespace pleinair::hal {

/// How text is set.
struct TextLayout {
  enum class TooWide { kEllipsis, kWrap };

  std::string font = "Sans";  ///< family and style: "Serif Italic"
  int fontPixels = 15;
  int maxWidth = kMaxSidePixels;         ///< of a line, in pixels
  TooWide tooWide = TooWide::kEllipsis;  ///< what becomes of a line that is wider
  bool isCentred = false;                ///< lines, to each other
};

/// Lines of UTF-8 (what is not is replaced) as coverage: a grey picture as large as the text needs,
/// 0 without ink and 255 within it. '\t' goes to a second column. The fonts are the system's
/// (Pango, fontconfig); where a family is missing, another stands in; where there is no font at
/// all, a place may be left empty. Any one thread.
Image textCoverage(const std::string& text, const TextLayout& layout);

}  // namespace pleinair::hal
