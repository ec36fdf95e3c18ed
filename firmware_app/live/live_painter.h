#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "firmware_app/live/live_controls.h"
#include "pipeline/engine/painter.h"
#include "pipeline/gpu/frames/import_trial.h"
#include "pipeline/runtime/paint/frame_painter.h"

namespace pleinair::app {

/// The engine's Painter for a live pipeline, in its own GL context. It applies the parameter sets
/// of its style and the snapshot requests of `controls`, which outlives it. Paint thread only.
class LivePainter final : public runtime::FramePainter {
 public:
  /// `start`: of the options' style; `machine`: what stills are about. Throws hal::Failure.
  LivePainter(const PainterOptions& options, LiveControls& controls,
              std::shared_ptr<const LiveParameters> start, const MachinePlace& machine = {});

  hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t quality) override;
  hal::Answer poll(std::size_t output, OutputFrame& frame) override;
  void wait(hal::Duration limit) override;
  void open(std::size_t output, const hal::OutputFormat& format) override;
  void close(std::size_t output) override;
  runtime::DrawableLayouts drawable() override;
  hal::Result<void> importLoan(std::size_t output, const runtime::SurfaceLoan& loan) override;
  void drawNextInto(std::size_t output, const hal::LentSurface& surface) override;
  std::span<const gpu::PassTime> passTimes() const override { return painter_.passTimes(); }
  const CameraPath* cameraPath() const override { return &painter_.cameraPath(); }

 private:
  void giveTags(const hal::CapturedFrame& frame, const Picture& picture);
  /// Hands out the camera's part of the frame that was painted, if one is wanted.
  void giveStill(const hal::CapturedFrame& frame, const Picture& picture);
  /// Paints a blank frame at each quality level with the first parameter set, which the Painter,
  /// warmed up with the defaults, does not know: buffers are allocated and programs used for the
  /// first time here instead of in the first frame.
  void warmUp(const PainterOptions& options);

  /// One that runs before surfaces are imported.
  struct Trial {
    Trial(std::uint64_t number, const hal::GpuSurface& surface) : loan(number), trial(surface) {}
    std::uint64_t loan;
    gpu::ImportTrial trial;
  };

  Painter painter_;
  std::map<std::size_t, Trial> trials_;  ///< by output
  LiveControls& controls_;
  std::vector<int> readbacks_;
  std::shared_ptr<const LiveParameters> seen_;  ///< the origin of parameters_
  PaintParameters parameters_;
  std::optional<tracking::CameraModel> camera_;  ///< of the scene
  hal::FrameSize pictureSize_;
  MachinePlace machine_;
};

}  // namespace pleinair::app
