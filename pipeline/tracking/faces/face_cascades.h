#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace pleinair::tracking {

inline constexpr std::size_t kFaceCascades = 2;

/// The classifiers of upright faces seen from the front that OpenCV comes with (Lienhart's
/// haarcascade_frontalface_alt and _alt2), as the XML that cv::FileStorage reads. Made at build.
const std::array<std::string_view, kFaceCascades>& faceCascades();

}  // namespace pleinair::tracking
