#include "hal/media/tone_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pleinair::hal::libav {
namespace {

constexpr std::size_t kGains = 4096;

/// SMPTE ST 2084's inverse EOTF, of nits, and its EOTF.
double pqOf(double nits) {
  const double y = std::pow(std::max(nits, 0.0) / 10000.0, 2610.0 / 16384.0);
  return std::pow((3424.0 / 4096.0 + 2413.0 / 128.0 * y) / (1.0 + 2392.0 / 128.0 * y),
                  2523.0 / 32.0);
}
double nitsOf(double pq) {
  const double e = std::pow(pq, 32.0 / 2523.0);
  const double y = std::max(e - 3424.0 / 4096.0, 0.0) / (2413.0 / 128.0 - 2392.0 / 128.0 * e);
  return 10000.0 * std::pow(y, 16384.0 / 2610.0);
}

/// BT.2390-10 §5.4.1, steps 1 to 4; all in cd/m².
double eetf(double nits, double sourcePeak, double targetPeak) {
  const double wholeRange = pqOf(sourcePeak);
  const double maxLum = pqOf(targetPeak) / wholeRange;
  const double kneeStart = std::max(1.5 * maxLum - 0.5, 0.0);
  const double e1 = std::min(pqOf(nits) / wholeRange, 1.0);
  if (e1 < kneeStart) return nits;
  const double t = (e1 - kneeStart) / (1.0 - kneeStart);
  const double t2 = t * t;
  const double t3 = t2 * t;
  const double e2 = (2 * t3 - 3 * t2 + 1) * kneeStart + (t3 - 2 * t2 + t) * (1 - kneeStart) +
                    (-2 * t3 + 3 * t2) * maxLum;
  return nitsOf(e2 * wholeRange);
}

}  // namespace

ToneCurve::ToneCurve(double peakNits)
    : peak_(static_cast<float>(std::max(peakNits / kReferenceWhiteNits, 1.0))),
      gain_(kGains + 1, 1.0F) {
  if (peak_ <= 1.0F) return;
  for (std::size_t i = 1; i <= kGains; ++i) {
    const double share = static_cast<double>(i) / kGains;
    const double light = double{peak_} * share * share;
    const double mapped = eetf(light * kReferenceWhiteNits, double{peak_} * kReferenceWhiteNits,
                               kReferenceWhiteNits) /
                          kReferenceWhiteNits;
    gain_[i] = static_cast<float>(mapped / light);
  }
}

float ToneCurve::map(float light) const {
  if (!(light > 0.0F)) return 0.0F;  // NaN as well
  if (light >= peak_) return 1.0F;
  const float at = static_cast<float>(kGains) * std::sqrt(light / peak_);
  const auto index = std::min(static_cast<std::size_t>(at), kGains - 1);
  const float share = at - static_cast<float>(index);
  const float gain = gain_[index] + share * (gain_[index + 1] - gain_[index]);
  return std::min(light * gain, 1.0F);
}

void ToneCurve::apply(float& red, float& green, float& blue) const {
  const float least = std::min({red, green, blue});
  if (least < 0.0F) {
    const float luminance = std::max(0.2126F * red + 0.7152F * green + 0.0722F * blue, 0.0F);
    const float share = luminance / (luminance - least);
    red = luminance + share * (red - luminance);
    green = luminance + share * (green - luminance);
    blue = luminance + share * (blue - luminance);
  }
  const float most = std::max({red, green, blue});
  const float gain = most > 0.0F ? map(most) / most : 0.0F;
  red *= gain;
  green *= gain;
  blue *= gain;
}

}  // namespace pleinair::hal::libav
