#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/engine/painter.h"
#include "pipeline/engine/readbacks.h"
#include "pipeline/gpu/aspect_fill.h"
#include "pipeline/gpu/frame_upload.h"
#include "pipeline/gpu/gpu_loss.h"
#include "pipeline/gpu/pass_timer.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/present/readback.h"
#include "pipeline/scene/light/light_estimator.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "pipeline/scene/render/buffer_views.h"
#include "pipeline/styles/style.h"
#include "pipeline/tracking/image/luma.h"
#include "pipeline/tracking/motion/canvas_motion.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair {

/// What a Painter does, on the thread of its GL context: each stage in its order, once a frame.
/// Painter's contract, but for threads.
class FramePipeline {
 public:
  FramePipeline(const PainterOptions& options, const gpu::ContextInfo& context);

  PaintParameters defaultParameters() const;
  std::vector<DebugView> views() const;
  std::vector<PainterLook> looks() const;
  config::ParameterValues lookParameters(std::string_view look) const;
  hal::Result<Picture> paint(const hal::CapturedFrame& frame, const PaintParameters& parameters);

  int openReadback(const hal::FrameFormat& format);
  hal::Result<bool> take(int reader, OutputFrame& picture, bool wait);
  bool hasRoom(int reader) const { return readers_.hasRoom(reader); }
  std::uint64_t skipped(int reader) const { return readers_.skipped(reader); }
  hal::Result<hal::Image> snapshot();
  hal::Result<hal::Image> cameraSnapshot();
  hal::Result<std::vector<marks::Anchor>> anchors();

  void reset();
  /// Why nothing comes any more, once the GPU is lost.
  const std::optional<hal::Error>& loss() const { return watch_.loss(); }
  std::vector<gpu::PassTime> passTimes() const;

 private:
  /// A level of quality that can be painted at.
  struct Level {
    hal::FrameSize size;
    std::optional<tracking::CameraModel> camera;  // of the picture at this size, not of the frame
  };

  void warmUp(const hal::FrameFormat& expected);
  void warmUp(const Level& level, const hal::Image& blank);
  hal::Result<void> checkView(const std::string& view) const;
  hal::Result<void> checkQuality(std::size_t quality) const;
  hal::Result<void> checkFrame(const hal::CapturedFrame& frame, const PaintParameters& parameters);
  hal::Result<void> adaptTo(hal::FrameSize frameSize);
  glm::dvec2 pixelsOfFull(const Level& level) const;
  gpu::AspectFill fitTo(const Level& level, hal::FrameSize frameSize) const;
  scene::ArFrame compose(const hal::CapturedFrame& frame, const tracking::TrackingResult& tracked,
                         const Level& level, scene::ArFrameNeeds needs);
  scene::ArFrameNeeds needsOf(const std::string& view) const;
  void followPicture(const hal::CapturedFrame& frame, scene::ArFrameNeeds needs,
                     scene::ArFrame& composed);
  const gpu::Texture& paintView(const scene::ArFrame& frame, const PaintParameters& parameters);
  hal::Result<hal::Image> read(const gpu::Texture* texture);
  hal::Error metLoss(const hal::Error& error);
  hal::Result<Picture> paintChecked(const hal::CapturedFrame& frame,
                                    const PaintParameters& parameters);

  gpu::ContextInfo context_;
  gpu::GpuTestHook testHook_;
  gpu::ResetMonitor watch_;
  hal::FrameSize pictureSize_;
  std::vector<Level> levels_;
  scene::Scene scene_;
  bool tracksTags_;
  gpu::ShaderLibrary library_;
  gpu::PassTimer timer_;
  gpu::FrameUploader uploader_;
  scene::ArFrameRenderer renderer_;
  scene::BufferViewer bufferViewer_;
  std::unique_ptr<styles::Style> style_;
  config::ParameterValues defaults_;  // of the style
  hal::FrameSize frameSize_;          // of the last frame; what follows is made for it
  std::optional<tracking::Tracker> tracker_;
  tracking::LumaFrame luma_;  // of the frame
  tracking::CanvasMotion motion_;
  tracking::ImageMotionEstimator imageMotion_;
  std::optional<scene::LightEstimator> light_;  // where the scene leaves it to the camera
  std::vector<scene::TagSighting> sightings_;
  Readbacks readers_;
  std::optional<present::Readback> snapshots_;  // made for the first still
  const gpu::Texture* picture_ = nullptr;       // of the last paint
  const gpu::Texture* camera_ = nullptr;
};

}  // namespace pleinair
