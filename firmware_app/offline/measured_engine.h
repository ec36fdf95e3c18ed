#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "pipeline/engine/painter.h"
#include "pipeline/measure/measurement.h"

namespace pleinair::app {

/// The optional contents of a PaintedFrame that a MeasuredEngine reads back.
struct MeasuredEngineOptions {
  bool readsMovers = false;  ///< labels of movers
  /// Which points of models are seen, and the picture with them. Precondition: the painter, or the
  /// composer, was made with PainterOptions::readsSurfaces.
  bool readsModels = false;
  /// Puts the models into the camera's picture, for a painter without a scene, which then paints
  /// it as a plain video: models in image space. Null: the painter's scene has them. It paints the
  /// style `none` and must outlive the engine.
  Painter* composer = nullptr;
};

/// The engine as a MeasuredPainter.
class MeasuredEngine final : public measure::MeasuredPainter {
 public:
  /// `painter` must outlive it and paints frames of `size`.
  MeasuredEngine(Painter& painter, PaintParameters parameters, hal::FrameSize size,
                 MeasuredEngineOptions options = {})
      : painter_(painter), parameters_(std::move(parameters)), size_(size), options_(options) {}

  hal::Result<measure::PaintedFrame> paint(const hal::CapturedFrame& frame) override;
  void reset() override;

 private:
  hal::Result<measure::PaintedFrame> paintComposed(const hal::CapturedFrame& frame);
  hal::Result<measure::PaintedFrame> paintAlone(const hal::CapturedFrame& frame);
  hal::Result<void> readModels(const Painter& shown, const hal::CapturedFrame& frame,
                               measure::PaintedFrame& painted) const;
  hal::Result<hal::Image> cameraPicture(const Painter& painter,
                                        const hal::CapturedFrame& frame) const;

  Painter& painter_;
  PaintParameters parameters_;
  hal::FrameSize size_;
  MeasuredEngineOptions options_;
};

}  // namespace pleinair::app
