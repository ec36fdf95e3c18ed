#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "hal/image.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"

namespace pleinair::tracking {

/// A sequence of images with known motion from each to the next.
struct MotionSequence {
  std::string name;
  std::vector<hal::Image> luma;
  /// From each frame to the next; empty if the image does not follow one.
  std::vector<glm::dmat3> homographies;
  /// The place in the next frame of the content at a place of frame `then`, px; nothing if it is
  /// unknown or hidden there.
  std::function<std::optional<glm::dvec2>(std::size_t then, const glm::dvec2& px)> moved;
};

/// desk_6dof's plane: 1280×720, motion blur. Precondition: hasDeskSequence().
MotionSequence deskMotion(std::size_t mostFrames = 1000);
/// virtual_camera: 640×480. Precondition: hasVirtualCamera().
MotionSequence virtualCameraMotion(std::size_t mostFrames = 1000);
/// synth_layers: 640×360, layers with a relative motion of some 10 px per frame.
MotionSequence layersMotion();
bool hasLayers();

/// Errors in px of the frame, each with its prediction.
struct Errors {
  std::vector<double> actual;
  std::vector<double> predicted;
  void add(double error, double prediction) {
    actual.push_back(error);
    predicted.push_back(prediction);
  }
  /// The median ratio of actual to predicted errors, relative to that of normally distributed
  /// errors: 1 if the predictions are right.
  double ratio() const;
  /// The part of the errors with the smallest predictions.
  Errors surest(double part) const;
};

/// The results of an estimator, from the third frame on.
struct MotionResult {
  std::size_t frames = 0;
  std::size_t cuts = 0;
  std::size_t pictures = 0;  ///< frames with a homography
  double featuresPerFrame = 0.0;
  Errors features;
  Errors picture;  ///< RMS over the frame, where the true one is known
  Errors flow;     ///< forward
  std::vector<double> milliseconds;
};
MotionResult measureMotion(const MotionSequence& sequence, const ImageMotionOptions& options);

}  // namespace pleinair::tracking
