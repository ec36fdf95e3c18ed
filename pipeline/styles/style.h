#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "config/parameter_values.h"
#include "hal/error.h"
#include "pipeline/gpu/pass_timer.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/anchor.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {
class AnchorSet;
}

namespace pleinair::styles {

/// A named preset of a style. Its values replace the defaults; what a person sets replaces both.
struct Look {
  std::string_view name;  ///< "wet_in_wet"
  std::string_view help;
  std::string_view toml;  ///< a table of the style's parameters, as in a configuration file
};

/// One of a style's inner pictures, for people who want to see how it works.
struct DebugViewInfo {
  std::string_view name;  ///< "cells"
  std::string_view help;
};

/// Turns AR frames into pictures. Keeps its own state between frames and knows nothing of cameras,
/// outputs or other styles. All calls on the thread of the GL context it was made in.
class Style {
 public:
  virtual ~Style() = default;
  Style() = default;
  Style(const Style&) = delete;
  Style& operator=(const Style&) = delete;
  Style(Style&&) = delete;
  Style& operator=(Style&&) = delete;

  virtual std::string_view name() const = 0;
  /// Its inner pictures, apart from the finished one.
  virtual std::span<const DebugViewInfo> views() const = 0;

  /// What it looks at of an AR frame beyond what each has.
  virtual scene::ArFrameNeeds needs() const { return {}; }

  /// Whether it looks at ArFrame::canvasFromPicture, which costs a little to find.
  virtual bool usesCanvas() const { return false; }

  /// The snapshot in force; its list() describes what can be tuned. At first the defaults.
  virtual const config::ParameterValues& parameters() const = 0;
  /// Makes ready what a snapshot names outside the program, such as a file. Errors: of that; the
  /// snapshot is not put in force then.
  virtual hal::Result<void> prepare([[maybe_unused]] const config::ParameterValues& values) {
    return {};
  }
  /// Puts another snapshot of the same list in force, from the next paint() on. Precondition: it
  /// was prepared.
  virtual void setParameters(const config::ParameterValues& values) = 0;

  /// Paints `frame`; the RGBA8 result (sRGB-coded, opaque) has the frame's size, row 0 at the top,
  /// and is valid until the next call. `view` is empty for the finished picture or names one of
  /// views(); the style's state advances the same whatever is looked at. Frames of another full
  /// size than the last reset it; of another size alone (a level of quality) they go on where it
  /// was. Each size is allocated for once.
  virtual const gpu::Texture& paint(const scene::ArFrame& frame, std::string_view view,
                                    gpu::PassTimer& timer) = 0;

  /// Its marks' anchors as they were painted last, of several layers the finest's; null where it
  /// has none.
  virtual const marks::AnchorSet* anchors() const { return nullptr; }
  /// Waits for the GPU and reads those of all layers, a slot each, free ones too: for measures.
  virtual std::vector<marks::Anchor> readAnchors() const { return {}; }

  /// Forgets the past: the next frame is painted as a first one.
  virtual void reset() = 0;
};

}  // namespace pleinair::styles
