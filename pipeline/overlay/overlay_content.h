#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/clock.h"
#include "hal/image.h"

namespace pleinair::overlay {

/// How a part of the machine is shown.
enum class PartLook {
  kPlain,    ///< painted, like its surroundings
  kFocus,    ///< crisp: no paint over it; outlined, hatched where other parts hide it
  kTint,     ///< crisp, and tinted in the reserved colour
  kOutline,  ///< painted, with an outline
  kHidden    ///< off the machine: it is not drawn, and hides nothing
};

/// A copy of a part, in the reserved colour, that moves between its place and another one.
struct Ghost {
  std::size_t part = 0;         ///< index in Model::parts
  glm::dvec3 apartMetres{0.0};  ///< the other place relative to its own, in the model's frame
  bool comesHome = false;       ///< it moves to its place (a part that is fitted), not from it
  bool stays = false;           ///< it stands at the other place: an exploded view
  friend bool operator==(const Ghost&, const Ghost&) = default;
};

/// What an arrow tells to do, along the part's own axis (PartShape::axis) or around it.
enum class ArrowKind { kPull, kPush, kTurn, kUnscrew, kScrew };
struct Arrow {
  ArrowKind kind = ArrowKind::kPull;
  std::size_t part = 0;
  glm::dvec3 axis{0.0, 0.0, 1.0};  ///< of the part's own axes, as alongAxis() takes it
  friend bool operator==(const Arrow&, const Arrow&) = default;
};

/// A picture that points at parts by a leader line.
struct Label {
  hal::Image picture;  ///< RGBA8, alpha premultiplied
  std::vector<std::size_t> parts;
};

/// A short movie that plays again and again, all of it in memory.
struct PanelMovie {
  struct Frame {
    hal::Duration begins{0};  ///< of the movie; that of the first is 0, and they rise
    hal::Image image;         ///< RGB8, all of one size
  };
  std::vector<Frame> frames;  ///< at least one
  hal::Duration length{0};    ///< until it begins again; more than the last frame's
};

/// Where a movie is drawn: px of the panel. Frames of another size are scaled.
struct MoviePlace {
  glm::ivec2 topLeft{0};
  hal::FrameSize size;
};

/// Why the overlay is not to be trusted.
enum class Doubt {
  kNone,
  kNotSeen,       ///< no pose
  kCarried,       ///< no tag of the machine has been seen for too long
  kUncertain,     ///< the predicted error at the part is too large
  kOutOfView,     ///< the step's parts are beside the picture
  kOtherMachine,  ///< tags of another machine are seen, and none of this one
  kContradicted   ///< the tags that place the machine contradict others
};
inline constexpr std::size_t kDoubts = 7;
std::string_view nameOf(Doubt doubt);

/// What is drawn over a painting of a machine: the content of one step. A value; immutable once it
/// is handed to a painter, so any thread may make it. All pictures are RGBA8 with premultiplied
/// alpha, made for the output's size, and drawn pixel for pixel; an empty one is not drawn.
struct OverlayContent {
  std::vector<PartLook> looks;  ///< per part of the machine's model; empty: all plain
  std::vector<Ghost> ghosts;
  std::vector<Arrow> arrows;
  std::vector<Label> labels;
  hal::Image panel;                         ///< the instruction; at the lower or upper edge
  std::shared_ptr<const PanelMovie> movie;  ///< over the panel; null: none
  MoviePlace moviePlace;
  hal::Image inset;  ///< the step drawn from the model, where nothing else is sure
  std::array<hal::Image, kDoubts> badges;  ///< by Doubt: why there is nothing on the machine
  bool showsInset = false;                 ///< always, not only in doubt
  std::vector<int> cards;  ///< ids of tags that hands show: they stand on no other machine
};

}  // namespace pleinair::overlay
