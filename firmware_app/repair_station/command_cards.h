#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "pipeline/procedure/step_command.h"

namespace pleinair::app {

/// A tag that a frame shows.
struct ShownTag {
  int id = 0;
  /// The shortest edge as a share of the frame's height. A card in a hand is large.
  double edgeShare = 0.0;
};

/// Command cards: tags that are shown to the camera for a second. A card fires once, and again only
/// after it was out of view for a second; cards that are in view at the start wait for that, too.
/// While two cards are in view, none fires: nobody knows which one is meant. One thread.
class CommandCards {
 public:
  static constexpr hal::Duration kShown = std::chrono::seconds(1);
  static constexpr hal::Duration kAway = std::chrono::seconds(1);
  /// Frames in between may miss a card that long.
  static constexpr hal::Duration kGap = std::chrono::milliseconds(300);
  /// A smaller tag is on a wall, and no card that somebody shows.
  static constexpr double kMinEdgeShare = 0.08;

  explicit CommandCards(std::map<int, procedure::StepCommand> cards);

  /// Takes the tags of a frame that was captured at `captured`; gives the command of a card that
  /// fires. A capture time that goes back, and a gap of frames, begin anew.
  std::optional<procedure::StepCommand> see(std::span<const ShownTag> tags,
                                            hal::TimePoint captured);

 private:
  struct Card {
    std::optional<hal::TimePoint> since;  ///< in view, alone, without a larger gap
    std::optional<hal::TimePoint> last;   ///< when it was seen last
    bool isSpent = false;                 ///< has fired, and was not away since
  };
  void restart();

  std::map<int, procedure::StepCommand> commands_;
  std::map<int, Card> cards_;
  std::optional<hal::TimePoint> frame_;
};

}  // namespace pleinair::app
