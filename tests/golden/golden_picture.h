#pragma once

#include <filesystem>
#include <string>

#include "hal/image.h"

namespace pleinair::golden {

/// How alike two pictures of one size are, over R, G and B.
struct Likeness {
  double psnrDecibels = 0.0;  ///< 99 where they are equal
  double ssim = 0.0;  ///< of luma, mean over 8×8 windows (Wang et al., 2004); 1 where equal
};
/// Precondition: RGB8 or RGBA8 of equal size.
Likeness likeness(const hal::ImageView& a, const hal::ImageView& b);

/// Holds `picture` (RGBA8) against the kept PNG. Empty where it is alike enough, else what is wrong
/// and where the picture and the difference (grey is none, 4-fold) were written. With
/// PLEINAIR_UPDATE_GOLDENS=1 in the environment the picture is kept as the new golden, its
/// difference from the old one written, and where said on standard error.
std::string compareWithGolden(const std::filesystem::path& golden, const hal::ImageView& picture,
                              Likeness least);

}  // namespace pleinair::golden
