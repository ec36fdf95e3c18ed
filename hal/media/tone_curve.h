#pragma once

#include <vector>

namespace pleinair::hal::libav {

/// The luminance of diffuse white that HDR films assume, in cd/m² (ITU-R BT.2408 §2.1): 1.0 of
/// linear light here, the white of an SDR picture.
inline constexpr double kReferenceWhiteNits = 203.0;

/// Maps linear light of an HDR film to that of an SDR picture by the EETF of ITU-R BT.2390-10
/// §5.4.1, with black at 0 and the target's peak at reference white: unchanged in the shadows and
/// mid-tones, and rolled off so that the film's peak becomes white.
class ToneCurve {
 public:
  /// `peakNits`: the film's brightest light. At or below reference white nothing is changed.
  explicit ToneCurve(double peakNits);

  /// The light that `light` (0 and up, 1 at reference white) becomes, at most 1.
  float map(float light) const;
  /// Maps one pixel of BT.709 primaries: all channels are scaled as the largest one is, which keeps
  /// the hue. A colour outside the gamut, with a negative channel, is first mixed with grey of its
  /// luminance until none is.
  void apply(float& red, float& green, float& blue) const;

 private:
  float peak_;               ///< in reference whites
  std::vector<float> gain_;  ///< map(x) / x at x = peak · (i / last)²
};

}  // namespace pleinair::hal::libav
