#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "config/parameter_values.h"
#include "hal/error.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/styles/coherence_gates.h"
#include "pipeline/styles/debug_views.h"

namespace pleinair::marks {
class AnchorSet;
class MotionLayers;
}  // namespace pleinair::marks

namespace pleinair::styles {

class Style;

/// A named preset of a style. Its values replace the defaults; what a person sets replaces both.
struct Look {
  std::string_view name;  ///< "wet_in_wet"
  std::string_view help;
  std::string_view toml;  ///< a table of the style's parameters, as in a configuration file
};

/// The contents of the frames that a style is to paint: it is warmed up for them.
enum class SceneContents { kCameraOnly, kModels };

/// The descriptor of a style: all that is known of it without a GPU, and how to make it. Each
/// style's folder exports one, which pipeline/styles/registry.cpp lists.
struct StyleKind {
  std::string_view name;
  std::string_view help;
  config::ParameterValues defaults;           ///< its list() describes what can be tuned
  std::span<const Look> looks = {};           ///< the first has the defaults' values
  std::span<const DebugViewInfo> views = {};  ///< its inner pictures, apart from the finished one
  scene::ArFrameNeeds needs = {};             ///< beyond what every AR frame has
  CoherenceGates coherence = {};              ///< what `measure --gates` holds it to
  std::vector<std::span<const gpu::EmbeddedShader>> shaders = {};  ///< of its own and its parts
  /// Whether files that parameters name are there and valid, without a GPU; null: they name none.
  hal::Result<void> (*check)(const config::ParameterValues& values) = nullptr;
  /// Makes one, on the thread of the current GL context, with its programs warmed up. `library`,
  /// which outlives it, has the shaders of all styles, marks and the scene.
  std::unique_ptr<Style> (*make)(const gpu::ShaderLibrary& library,
                                 SceneContents contents) = nullptr;

  /// The defaults under the look's values, whose origin names the look. Throws config::ConfigError
  /// for an unknown name, with all names.
  config::ParameterValues parametersOf(std::string_view look) const;
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

  /// The style's descriptor.
  virtual const StyleKind& kind() const = 0;

  /// What the parameters in force need of AR frames: at most what the descriptor says.
  virtual scene::ArFrameNeeds needs() const { return kind().needs; }

  /// The parameter set in force. At first the defaults.
  virtual const config::ParameterValues& parameters() const = 0;
  /// Loads the files that a parameter set names. Errors: those of the file; the set in force stays
  /// as it was.
  virtual hal::Result<void> prepare([[maybe_unused]] const config::ParameterValues& values) {
    return {};
  }
  /// Puts another set of the same list in force, from the next paint() on. Precondition: it
  /// was prepared.
  virtual void setParameters(const config::ParameterValues& values) = 0;

  /// Paints `frame`; the RGBA8 result (sRGB-coded, opaque) has the frame's size, row 0 at the top,
  /// and is valid until the next call. `view` is empty for the finished picture or names one of
  /// the descriptor's views; the style's state advances the same for each. A frame of another full
  /// size than the last resets it; a frame of another size alone (a quality level) does not. Each
  /// size is allocated for once.
  virtual const gpu::Texture& paint(const scene::ArFrame& frame, std::string_view view) = 0;

  /// Its marks' anchors as they were painted last, of several layers the finest's; null where it
  /// has none.
  virtual const marks::AnchorSet* anchors() const { return nullptr; }
  /// Waits for the GPU and reads the anchors of all layers, a slot each, free ones too: for
  /// measures.
  virtual std::vector<marks::Anchor> readAnchors() const { return {}; }

  /// The movers and background of the last frame; null where the style does not tell them apart.
  virtual const marks::MotionLayers* movers() const { return nullptr; }

  /// Forgets the past: the next frame is painted as a first one.
  virtual void reset() = 0;
};

}  // namespace pleinair::styles
