#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/reports/overlay/bench_machine.h"

namespace pleinair::overlay_truth {

inline constexpr hal::FrameSize kSize{640, 480};
inline constexpr double kWrongPx = 5.0;
inline constexpr double kRightPx = 2.0;
inline const std::vector<int> kAllTags{0, 1, 2, 3, 4};

/// Changes a frame before it is tracked.
using Change = std::function<void(const BenchMachine&, std::uint64_t, hal::Image&)>;

/// A film of the bench, 20 frames a second.
struct Film {
  hal::SyntheticOptions options;
  std::vector<int> tags;  ///< that the scene knows
  int frames = 40;
  Change change = nullptr;
  std::size_t skipped = 0;                               ///< frames at its beginning
  std::function<void(scene::Scene&)> author = nullptr;   ///< changes the scene
  std::optional<std::uint64_t> goneFrom = std::nullopt;  ///< another machine stands there since
  std::vector<int> cards;                                ///< command cards
  std::optional<std::uint64_t> painterAnewAt = std::nullopt;  ///< as after a lost GPU
  bool keepsDoubts = true;                                    ///< over that
  /// Frames that the camera rests for, each time it has moved on for `moves`: 0: it never rests.
  int rests = 0;
  int moves = 8;
};

/// One frame, as it was and as it was shown.
struct Moment {
  /// True error at the worst of the step's parts, px; nothing: there is no place, or another
  /// machine in it.
  std::optional<double> errorPx;
  double predictedPx = 0.0;
  float opacity = 0.0F;
  overlay::Doubt doubt = overlay::Doubt::kNone;

  bool isWrong() const { return !errorPx || *errorPx > kWrongPx; }
  bool isRight() const { return errorPx && *errorPx <= kRightPx; }
};

/// Paints the film with a step about four small bolts, and compares with the true poses. Throws
/// hal::Failure.
std::vector<Moment> play(Film film);

struct Counts {
  int frames = 0;
  int wrongAndShown = 0;  ///< any opacity
  int wrong = 0;
  int right = 0;
  int rightAndShown = 0;  ///< at least half
  double worstShownPx = 0.0;
  /// Right ones that are not shown, by reason; kNone: it comes back.
  std::array<int, overlay::kDoubts> hiddenBy{};
  int otherMachine = 0;  ///< frames in which one is believed to be seen
};
Counts countsOf(const std::vector<Moment>& moments);

/// Paints a rectangle over where a tag is, with its white border.
void cover(const BenchMachine& bench, std::uint64_t sequence, int tag, hal::Image& image);
/// Shows tag `from` where tag `to` is.
void showInstead(const BenchMachine& bench, std::uint64_t sequence, int from, int to,
                 hal::Image& image);

/// The films that the station's figures are of (docs/measured.md).
struct NamedFilm {
  std::string name;
  Film film;
};
std::vector<NamedFilm> truthFilms();

}  // namespace pleinair::overlay_truth
