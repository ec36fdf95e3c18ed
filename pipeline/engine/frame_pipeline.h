#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/engine/frame_luma.h"
#include "pipeline/engine/open_readback.h"
#include "pipeline/engine/painter.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/frames/camera_frames.h"
#include "pipeline/gpu/gpu_loss.h"
#include "pipeline/gpu/images/aspect_fill.h"
#include "pipeline/gpu/programs/host_state.h"
#include "pipeline/gpu/programs/pass_timer.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/overlay/overlay_renderer.h"
#include "pipeline/present/readback.h"
#include "pipeline/scene/light/light_estimator.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "pipeline/scene/render/buffer_views.h"
#include "pipeline/styles/style.h"
#include "pipeline/tracking/faces/face_tracker.h"
#include "pipeline/tracking/motion/canvas_motion.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"
#include "pipeline/tracking/pose/tracker.h"
#include "pipeline/tracking/segments/image_segmenter.h"

namespace pleinair {

/// The GL context that a Painter works in.
struct PainterGl {
  std::unique_ptr<gpu::EglContext> own;  ///< null: the host's context
  gpu::ContextInfo info;
};

/// Makes the Painter's context current on the calling thread, in the state that its passes rely on.
/// The destructor restores the host's context as PainterContext specifies.
class ContextScope {
 public:
  /// `monitor` is notified if the driver refuses the Painter's own context; null for a new context.
  /// The state of a host is left alone after a loss, because another context may be current.
  ContextScope(const PainterGl& gl, gpu::ResetMonitor* monitor);

 private:
  std::optional<gpu::CurrentContextKeeper> previous_;
  std::optional<gpu::HostState> hostState_;
};

/// A Painter's GL objects and stages, and the order in which a frame passes through them. The
/// members of Painter (painter.cpp) use it inside a ContextScope. Paint thread only.
class FramePipeline {
 public:
  /// Precondition: the context is current.
  FramePipeline(const PainterOptions& options, PainterGl gl);

 private:
  friend class Painter;

  /// A quality level that can be painted at.
  struct Level {
    hal::FrameSize size;
    std::optional<tracking::CameraModel> camera;  // of the picture, not of the frame
  };

  /// Enters the context for a call of the Painter.
  ContextScope enter() { return {gl_, &resetMonitor_}; }
  void warmUp(const hal::FrameFormat& expected);
  void warmUp(const Level& level, const hal::Image& blank);
  hal::Result<void> checkQuality(std::size_t quality) const;
  hal::Result<void> checkFrame(const hal::CapturedFrame& frame, const PaintParameters& parameters);
  hal::Result<void> adaptTo(hal::FrameSize frameSize);
  std::optional<hal::FrameMapping> takeLuma(const hal::CapturedFrame& frame,
                                            scene::ArFrameNeeds needs);
  glm::dvec2 pixelsOfFull(const Level& level) const;
  gpu::AspectFill fitTo(const Level& level, hal::FrameSize frameSize) const;
  scene::ArFrame compose(const hal::CapturedFrame& frame, const tracking::TrackingResult& tracked,
                         const Level& level, scene::ArFrameNeeds needs,
                         const tracking::ImageMotion* motion);
  scene::ArFrameNeeds needsOf(const std::string& view) const;
  const tracking::ImageMotion* measureMotion(std::uint64_t sequence, scene::ArFrameNeeds needs);
  void addMotion(const tracking::ImageMotion& motion, scene::ArFrameNeeds needs,
                 scene::ArFrame& composed);
  void addSegments(const hal::ImageView& image, const tracking::ImageMotion& motion,
                   scene::ArFrame& composed);
  void addFaces(hal::TimePoint captureTime, bool isCut, scene::ArFrame& composed);
  void forgetPast();
  void takeOverlay(const PaintParameters& parameters);
  bool isMachineSeen(const tracking::TrackingResult& tracked) const;
  void drawOverlay(const scene::ArFrame& frame, const tracking::TrackingResult& tracked);
  const gpu::Texture& paintView(const scene::ArFrame& frame, const PaintParameters& parameters);
  hal::Result<hal::Image> read(const gpu::Texture* texture);
  hal::Answer copyOldest(int number, OutputFrame& frame,
                         hal::Answer (present::Readback::*copy)(hal::Image&), bool waits);
  void forgetSurfaces();
  void submitReadbacks(const hal::CapturedFrame& frame);
  /// Gives the loss of the GPU if that caused `error`, otherwise `error`.
  hal::Error orLoss(const hal::Error& error);
  /// Implements Painter::paint().
  hal::Result<Picture> paint(const hal::CapturedFrame& frame, const PaintParameters& parameters);
  hal::Result<Picture> paintChecked(const hal::CapturedFrame& frame,
                                    const PaintParameters& parameters);

  PainterGl gl_;
  gpu::GpuTestHook testHook_;
  gpu::ResetMonitor resetMonitor_;
  hal::FrameSize pictureSize_;
  std::vector<Level> levels_;
  scene::Scene scene_;
  bool tracksTags_;
  bool readsSurfaces_;
  gpu::ShaderLibrary library_;
  gpu::PassTimer timer_;
  gpu::CameraFrames frames_;
  FrameLuma luma_;  // of the frame being painted
  CameraPath cameraPath_;
  scene::ArFrameRenderer renderer_;
  scene::BufferViewer bufferViewer_;
  std::unique_ptr<styles::Style> style_;
  config::ParameterValues defaults_;  // of the style
  hal::FrameSize frameSize_;          // of the last frame, which the next two members are for
  std::optional<tracking::Tracker> tracker_;
  tracking::CanvasMotion motion_;
  tracking::ImageMotionEstimator imageMotion_;
  tracking::ImageSegmenter segmenter_;
  std::optional<tracking::FaceTracker> faces_;  // if the style may ask for them
  std::optional<scene::LightEstimator> light_;       // if the scene's light is estimated
  std::optional<overlay::OverlayRenderer> overlay_;  // if there is a machine
  std::optional<tracking::CameraModel> fullCamera_;  // of the full picture
  std::vector<scene::TagSighting> sightings_;
  std::map<int, OpenReadback> readbacks_;
  int nextReadback_ = 0;
  std::uint64_t paintings_ = 0;
  std::optional<present::Readback> snapshots_;  // created for the first snapshot
  const gpu::Texture* picture_ = nullptr;       // the last picture
  const gpu::Texture* camera_ = nullptr;
  const gpu::Texture* composed_ = nullptr;
};

}  // namespace pleinair
