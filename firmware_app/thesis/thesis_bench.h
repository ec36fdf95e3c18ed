#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/captured_frame.h"
#include "pipeline/engine/painter.h"
#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/measure/measurement.h"

namespace pleinair::app {

/// How large and how long the films are.
struct ThesisSize {
  hal::FrameSize picture{432, 324};
  std::uint64_t settle = 16;  ///< frames painted before the shown and measured ones
  std::uint64_t frames = 25;  ///< of these
  int runs = 15;              ///< of what is timed
  bool isQuick = false;
};
ThesisSize quickThesisSize();

/// The models of the films, on the workbench's tag.
enum class FilmModel {
  kNone,
  kGearbox,  ///< static: for the thesis's spaceship, tower and dragon
  kTube,     ///< a skin: for its running figure
  kBall,     ///< morph targets
};

/// A film and how it is painted. The style is painterly.
struct FilmRequest {
  FilmModel model = FilmModel::kGearbox;
  bool isImageSpace = false;  ///< as measure's --image-space
  hal::SyntheticShot shot = hal::SyntheticShot::kWalkaround;
  std::vector<std::pair<std::string, std::string>> parameters = {};  ///< other than the defaults
  auto operator<=>(const FilmRequest&) const = default;
};

/// A frame of a film: RGB.
struct FilmFrame {
  cv::Mat3b input, output;
  cv::Mat1b models;  ///< 255 where it shows one
  std::vector<marks::Anchor> anchors;
};

struct MeasuredFilm {
  measure::Report report;
  std::vector<FilmFrame> frames;  ///< four of them, evenly spread over the measured ones
};

/// Ends the making of a report: a signal was received.
struct ThesisInterrupted {};

/// Makes, paints and measures the films of the report, each once. One thread. Throws hal::Failure
/// as Painter and measure::measure() do, and ThesisInterrupted.
class ThesisBench {
 public:
  /// `goesOn` is asked after each frame.
  ThesisBench(ThesisSize size, std::function<bool()> goesOn);
  ~ThesisBench();
  ThesisBench(const ThesisBench&) = delete;
  ThesisBench& operator=(const ThesisBench&) = delete;

  const ThesisSize& size() const { return size_; }
  /// The film, measured; kept for the next request of the same.
  const MeasuredFilm& measured(const FilmRequest& request);
  /// Paints settle + frames frames. `viewOf` gives each one's debug view (empty: the painting),
  /// `each` is called with it; both count from 0. The painter can be asked for snapshots,
  /// anchors and surfaces. Precondition: not in image space.
  void paint(const FilmRequest& request, const std::function<std::string(std::uint64_t)>& viewOf,
             const std::function<void(std::uint64_t, Painter&)>& each);
  /// The frames of the camera alone.
  std::vector<hal::CapturedFrame> cameraFrames(std::uint64_t count);
  /// A painter of pictures without a scene.
  Painter& plainPainter();
  /// Controls of measured films that failed so far.
  const std::vector<std::string>& failedControls() const { return failedControls_; }

 private:
  Painter& painterOf(FilmModel model, bool isComposer);
  void throwIfInterrupted() const;

  ThesisSize size_;
  std::function<bool()> goesOn_;
  std::map<std::pair<FilmModel, bool>, std::unique_ptr<Painter>> painters_;
  std::map<FilmRequest, MeasuredFilm> films_;
  std::vector<std::string> failedControls_;
};

/// An RGB8 image as a matrix of its own, and back.
cv::Mat3b matrixOf(const hal::Image& rgb);
hal::Image imageOf(const cv::Mat3b& rgb);

}  // namespace pleinair::app
