#include "pipeline/styles/painterly/brushes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace pleinair::styles {
namespace {

constexpr int kSamples = 3;  // of a texel, along each side

/// How a brush marks.
struct Hairs {
  int bristles;      // across
  double depth;      // of the furrows between them, in [0, 1]
  double dryness;    // how much of the paint is missing where bristles have run dry
  double runsDry;    // how much more so towards the end
  double roundness;  // of the ends, in widths
  double softness;   // of the sides, in half widths
  double streak;     // how far a bristle's mark goes on alike, as a part of the stroke
  double ridge;      // how high paint is pushed up along the sides
  double grain;      // of the paper, that breaks the mark
};

Hairs hairsOf(Brush brush) {
  switch (brush) {
    case Brush::kRound:
      return {14, 0.55, 0.10, 0.35, 0.8, 0.35, 0.55, 0.25, 0.0};
    case Brush::kFlat:
      return {22, 0.60, 0.08, 0.30, 0.25, 0.16, 0.70, 0.40, 0.0};
    case Brush::kDry:
      return {26, 0.75, 0.45, 0.75, 0.35, 0.25, 0.45, 0.10, 0.25};
    case Brush::kKnife:
      return {5, 0.25, 0.05, 0.20, 0.10, 0.07, 0.90, 0.80, 0.0};
    case Brush::kMarker:
      return {3, 0.05, 0.00, 0.05, 0.9, 0.12, 0.90, 0.00, 0.0};
    case Brush::kPencil:
      return {7, 0.35, 0.22, 0.10, 0.5, 0.60, 0.30, 0.00, 0.35};
  }
  return {};
}

double smooth(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// std::floor() is a call where the processor's newer instructions may not be used; a brush takes
/// millions of them.
int floorOf(double x) {
  const auto whole = static_cast<int>(x);
  return x < whole ? whole - 1 : whole;
}

/// Smooth noise on a line or plane, in [0, 1], from random numbers at whole places.
class Noise {
 public:
  explicit Noise(unsigned seed) : values_(4096) {
    std::mt19937 random(seed);
    for (double& each : values_) each = static_cast<double>(random()) / 4294967295.0;
  }
  double operator()(double x, double y) const {
    const int ix = floorOf(x);
    const int iy = floorOf(y);
    const double u = smooth(0.0, 1.0, x - ix);
    const double v = smooth(0.0, 1.0, y - iy);
    const double above = at(ix, iy) * (1.0 - u) + at(ix + 1, iy) * u;
    const double below = at(ix, iy + 1) * (1.0 - u) + at(ix + 1, iy + 1) * u;
    return above * (1.0 - v) + below * v;
  }

 private:
  double at(int x, int y) const {
    const unsigned index = static_cast<unsigned>(x) * 73U + static_cast<unsigned>(y) * 1619U;
    return values_[index % values_.size()];
  }
  std::vector<double> values_;
};

struct Mark {
  double cover;
  double height;
};

/// u along, v across the stroke, both in [0, 1].
Mark markAt(const Hairs& hairs, const Noise& noise, double u, double v) {
  const double across = 2.0 * v - 1.0;
  // Each bristle is set down and lifted by itself.
  const double setDown = noise(v * hairs.bristles * 0.8, 3.0);
  const double lifted = 0.6 * noise(v * hairs.bristles * 0.8, 5.0) + 0.4 * noise(v * 4.0, 6.0);
  const double arc = hairs.roundness * (1.0 - std::sqrt(std::max(0.0, 1.0 - across * across)));
  const double fromStart = u - 0.01 - 0.11 * arc - 0.07 * setDown;
  const double fromEnd = 1.0 - u - 0.01 - 0.13 * arc - (0.10 + 0.14 * hairs.runsDry) * lifted;
  const double ends = smooth(0.0, 0.05, fromStart) * smooth(0.0, 0.09, fromEnd);

  const double wavy = across + 0.08 * (noise(u * 5.0, 11.0) - 0.5);
  const double sides = 1.0 - smooth(1.0 - hairs.softness, 1.0, std::abs(wavy));

  // Bristles, which waver a little on their way.
  const double lane = v * hairs.bristles + 0.5 * (noise(u * 3.0, 7.0) - 0.5);
  const double bristle = noise(lane, u / hairs.streak * 2.0);
  const double fine = noise(lane * 2.7 + 40.0, u / hairs.streak * 3.0 + 9.0);
  const double hair = 0.65 * bristle + 0.35 * fine;

  const double dry = hairs.dryness + hairs.runsDry * smooth(0.45, 1.0, u) * 0.8;
  const double missing = smooth(1.0 - 0.75 * dry, 1.02 - 0.45 * dry, 1.0 - hair);
  const double paper = noise(u * 90.0, v * 26.0);
  const double broken = 1.0 - hairs.grain * smooth(0.42, 0.62, paper);
  const double cover = ends * sides * (1.0 - missing) * broken;

  const double pushed = hairs.ridge * smooth(0.62, 0.85, std::abs(across)) *
                        (1.0 - smooth(0.88, 1.0, std::abs(across)));
  const double body = 1.0 - hairs.depth * (1.0 - hair);
  const double piled = 0.25 * hairs.ridge * smooth(0.6, 0.85, u);
  return {.cover = cover, .height = std::clamp(0.65 * body + 0.5 * pushed + piled, 0.0, 1.0)};
}

std::atomic<std::uint64_t> brushCount = 0;

std::uint8_t byteOf(double part) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(part, 0.0, 1.0)));
}

}  // namespace

gpu::Texture makeBrush(Brush brush, int across) {
  ++brushCount;
  const Hairs hairs = hairsOf(brush);
  const auto along = static_cast<int>(kBrushAspect) * across;
  const hal::FrameSize size{along, across * kBrushVariants};
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(size.pixels()) * 2);
  std::vector<Noise> noises;
  for (unsigned variant = 0; variant < kBrushVariants; ++variant) {
    noises.emplace_back(17U + 31U * variant + 101U * static_cast<unsigned>(brush));
  }
  for (int y = 0; y < size.height; ++y) {
    const Noise& noise = noises[static_cast<std::size_t>(y / across)];
    for (int x = 0; x < size.width; ++x) {
      Mark sum{.cover = 0.0, .height = 0.0};
      for (int i = 0; i < kSamples * kSamples; ++i) {
        const double u = (x + (i % kSamples + 0.5) / kSamples) / size.width;
        const double v = (y % across + (i / kSamples + 0.5) / kSamples) / across;
        const Mark mark = markAt(hairs, noise, u, v);
        sum.cover += mark.cover;
        sum.height += mark.height;
      }
      bytes.push_back(byteOf(sum.cover / (kSamples * kSamples)));
      bytes.push_back(byteOf(sum.height / (kSamples * kSamples)));
    }
  }
  gpu::Texture texture(gpu::TextureFormat::kRg8, size, gpu::TextureFilter::kLinear);
  texture.upload(bytes, static_cast<std::size_t>(size.width) * 2);
  return texture;
}

std::uint64_t brushesMade() {
  return brushCount;
}

}  // namespace pleinair::styles
