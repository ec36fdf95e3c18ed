#include "pipeline/styles/strokes/brushes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace pleinair::styles {
namespace {

constexpr std::size_t kSamples = 3;  // of a texel, along each side

/// The bristles of a brush and the mark that they leave.
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
  explicit Noise(unsigned seed) : values_(kValues) {
    std::mt19937 random(seed);
    for (double& each : values_) each = static_cast<double>(random()) / 4294967295.0;
  }
  double operator()(double x, double y) const {
    const int ix = floorOf(x);
    const int iy = floorOf(y);
    const double u = eased(x - ix);
    const double v = eased(y - iy);
    const double above = at(ix, iy) * (1.0 - u) + at(ix + 1, iy) * u;
    const double below = at(ix, iy + 1) * (1.0 - u) + at(ix + 1, iy + 1) * u;
    return above * (1.0 - v) + below * v;
  }

 private:
  static constexpr unsigned kValues = 4096;  // a constant, by which a division is a mask

  static double eased(double part) { return part * part * (3.0 - 2.0 * part); }
  double at(int x, int y) const {
    const unsigned index = static_cast<unsigned>(x) * 73U + static_cast<unsigned>(y) * 1619U;
    return values_[index % kValues];
  }
  std::vector<double> values_;
};

struct Mark {
  double cover;
  double height;
};

/// The terms of a mark that depend only on the place along the stroke.
struct AlongTerms {
  double u;  // in [0, 1]
  double waver;
  double laneShift;
  double dry;
  double piled;
};

AlongTerms alongAt(const Hairs& hairs, const Noise& noise, double u) {
  return {.u = u,
          .waver = 0.08 * (noise(u * 5.0, 11.0) - 0.5),
          .laneShift = 0.5 * (noise(u * 3.0, 7.0) - 0.5),
          .dry = hairs.dryness + hairs.runsDry * smooth(0.45, 1.0, u) * 0.8,
          .piled = 0.25 * hairs.ridge * smooth(0.6, 0.85, u)};
}

/// The terms of a mark that depend only on the place across the stroke.
struct AcrossTerms {
  double v;  // in [0, 1]
  double across;
  double setDown;
  double lifted;
  double arc;
  double pushed;
};

AcrossTerms acrossAt(const Hairs& hairs, const Noise& noise, double v) {
  const double across = 2.0 * v - 1.0;
  return {.v = v,
          .across = across,
          // Each bristle is set down and lifted by itself.
          .setDown = noise(v * hairs.bristles * 0.8, 3.0),
          .lifted = 0.6 * noise(v * hairs.bristles * 0.8, 5.0) + 0.4 * noise(v * 4.0, 6.0),
          .arc = hairs.roundness * (1.0 - std::sqrt(std::max(0.0, 1.0 - across * across))),
          .pushed = hairs.ridge * smooth(0.62, 0.85, std::abs(across)) *
                    (1.0 - smooth(0.88, 1.0, std::abs(across)))};
}

Mark markAt(const Hairs& hairs, const Noise& noise, const AlongTerms& along,
            const AcrossTerms& row) {
  const double u = along.u;
  const double fromStart = u - 0.01 - 0.11 * row.arc - 0.07 * row.setDown;
  const double fromEnd =
      1.0 - u - 0.01 - 0.13 * row.arc - (0.10 + 0.14 * hairs.runsDry) * row.lifted;
  const double ends = smooth(0.0, 0.05, fromStart) * smooth(0.0, 0.09, fromEnd);
  const double sides = 1.0 - smooth(1.0 - hairs.softness, 1.0, std::abs(row.across + along.waver));

  // Bristles, which waver a little on their way.
  const double lane = row.v * hairs.bristles + along.laneShift;
  const double bristle = noise(lane, u / hairs.streak * 2.0);
  const double fine = noise(lane * 2.7 + 40.0, u / hairs.streak * 3.0 + 9.0);
  const double hair = 0.65 * bristle + 0.35 * fine;

  const double dry = along.dry;
  const double missing = smooth(1.0 - 0.75 * dry, 1.02 - 0.45 * dry, 1.0 - hair);
  double cover = ends * sides * (1.0 - missing);
  if (hairs.grain > 0.0) {
    const double paper = noise(u * 90.0, row.v * 26.0);
    cover *= 1.0 - hairs.grain * smooth(0.42, 0.62, paper);
  }
  const double body = 1.0 - hairs.depth * (1.0 - hair);
  return {.cover = cover,
          .height = std::clamp(0.65 * body + 0.5 * row.pushed + along.piled, 0.0, 1.0)};
}

std::atomic<std::uint64_t> brushCount = 0;

/// Where a texel's sample lies, in texels from its edge.
double sampleAt(std::size_t number) {
  return (static_cast<double>(number) + 0.5) / kSamples;
}

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
  std::vector<AlongTerms> columns(static_cast<std::size_t>(size.width) * kSamples);
  for (unsigned variant = 0; variant < kBrushVariants; ++variant) {
    const Noise noise(17U + 31U * variant + 101U * static_cast<unsigned>(brush));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::size_t column = i / kSamples;
      const double x = static_cast<double>(column) + sampleAt(i % kSamples);
      columns[i] = alongAt(hairs, noise, x / size.width);
    }
    for (int y = 0; y < across; ++y) {
      std::array<AcrossTerms, kSamples> rows{};
      for (std::size_t i = 0; i < kSamples; ++i) {
        rows[i] = acrossAt(hairs, noise, (y + sampleAt(i)) / across);
      }
      for (std::size_t x = 0; x < columns.size(); x += kSamples) {
        Mark sum{.cover = 0.0, .height = 0.0};
        for (const AcrossTerms& row : rows) {
          for (std::size_t i = 0; i < kSamples; ++i) {
            const Mark mark = markAt(hairs, noise, columns[x + i], row);
            sum.cover += mark.cover;
            sum.height += mark.height;
          }
        }
        bytes.push_back(byteOf(sum.cover / (kSamples * kSamples)));
        bytes.push_back(byteOf(sum.height / (kSamples * kSamples)));
      }
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
