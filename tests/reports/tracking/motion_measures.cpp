#include "tests/reports/tracking/motion_measures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/media/picture_file.h"
#include "pipeline/measure/input/kitti_flow.h"
#include "pipeline/tracking/image/homography.h"
#include "tests/reports/tracking/pose_measures.h"
#include "tests/reports/tracking/truth_sequence.h"
#include "tests/unit/tracking/desk_sequence.h"

namespace pleinair::tracking {
namespace {

const std::filesystem::path kLayers =
    std::filesystem::path(PLEINAIR_SHARED_DATA) / "flow/synth_layers";

glm::dmat3 matrixOf(const CameraModel& camera) {
  const Intrinsics& k = camera.intrinsics();
  return {k.fx, 0.0, 0.0, 0.0, k.fy, 0.0, k.cx, k.cy, 1.0};
}

/// The sequence of a plane, bounded or endless, from the homography of its places to px of each
/// frame.
MotionSequence planeMotion(TruthSequence sequence, const std::vector<glm::dmat3>& pxFromPlane) {
  MotionSequence out{.name = sequence.name, .luma = {}, .homographies = {}, .moved = {}};
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    out.luma.push_back(std::move(sequence.frames[i].luma));
    if (i > 0) out.homographies.push_back(pxFromPlane[i] * glm::inverse(pxFromPlane[i - 1]));
  }
  out.moved = [homographies = out.homographies](std::size_t then, const glm::dvec2& px) {
    return std::optional(movedBy(homographies[then], px));
  };
  return out;
}

void keep(TruthSequence& sequence, std::size_t mostFrames) {
  if (sequence.frames.size() > mostFrames) sequence.frames.resize(mostFrames);
}

}  // namespace

MotionSequence deskMotion(std::size_t mostFrames) {
  TruthSequence desk = readDesk();
  keep(desk, mostFrames);
  std::vector<glm::dmat3> pxFromPlane;
  for (const TruthFrame& frame : desk.frames) {
    const glm::dmat4& pose = frame.cameraFromWorld;  // the plane is z = 0
    pxFromPlane.push_back(matrixOf(desk.camera) * glm::dmat3(glm::dvec3(pose[0]),
                                                             glm::dvec3(pose[1]),
                                                             glm::dvec3(pose[3])));
  }
  return planeMotion(std::move(desk), pxFromPlane);
}

MotionSequence virtualCameraMotion(std::size_t mostFrames) {
  TruthSequence camera = readVirtualCamera();
  keep(camera, mostFrames);
  std::vector<glm::dmat3> pxFromPlane;  // directions
  for (const TruthFrame& frame : camera.frames) {
    pxFromPlane.push_back(matrixOf(camera.camera) * glm::dmat3(frame.cameraFromWorld));
  }
  return planeMotion(std::move(camera), pxFromPlane);
}

bool hasLayers() {
  return std::filesystem::exists(kLayers);
}

MotionSequence layersMotion() {
  MotionSequence out{.name = "synth_layers", .luma = {}, .homographies = {}, .moved = {}};
  auto flows = std::make_shared<std::vector<measure::KittiFlowField>>();
  for (int i = 0; std::filesystem::exists(kLayers / fmt::format("frame_{:04}.png", i)); ++i) {
    const hal::Image rgb = hal::readPictureRgb(kLayers / fmt::format("frame_{:04}.png", i)).value();
    hal::Image luma({.pixelFormat = hal::PixelFormat::kGrey8, .size = rgb.size()});
    hal::Image copy(rgb.view());
    const cv::Size size(rgb.size().width, rgb.size().height);
    cv::Mat grey(size, CV_8UC1, luma.plane(0).data());
    cv::cvtColor(cv::Mat(size, CV_8UC3, copy.plane(0).data()), grey, cv::COLOR_RGB2GRAY);
    out.luma.push_back(std::move(luma));
    if (i == 0) continue;
    const std::string pair = fmt::format("_{:04}_{:04}.png", i - 1, i);
    flows->push_back(measure::readKittiFlow(kLayers / ("flow" + pair), size).value());
    const bool isMasked = measure::maskOut(flows->back(), kLayers / ("occ" + pair)).has_value();
    if (!isMasked) flows->back().seen = 0;
  }
  out.moved = [flows](std::size_t then, const glm::dvec2& px) -> std::optional<glm::dvec2> {
    const measure::KittiFlowField& field = (*flows)[then];
    const cv::Point at(static_cast<int>(std::floor(px.x)), static_cast<int>(std::floor(px.y)));
    if (!cv::Rect({}, field.px.size()).contains(at) || field.seen(at) == 0) return std::nullopt;
    return px + glm::dvec2(field.px(at)[0], field.px(at)[1]);
  };
  return out;
}

double Errors::ratio() const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < actual.size(); ++i) ratios.push_back(actual[i] / predicted[i]);
  constexpr double kMedianOfNormal = 0.8326;  // for the length over two axes, relative to its RMS
  return percentile(std::move(ratios), 0.5) / kMedianOfNormal;
}

Errors Errors::surest(double part) const {
  std::vector<std::size_t> order(actual.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [this](std::size_t i) { return predicted[i]; });
  order.resize(static_cast<std::size_t>(part * static_cast<double>(order.size())));
  Errors out;
  for (const std::size_t i : order) out.add(actual[i], predicted[i]);
  return out;
}

MotionResult measureMotion(const MotionSequence& sequence, const ImageMotionOptions& options) {
  ImageMotionEstimator estimator(options);
  MotionResult out;
  for (std::size_t i = 0; i < sequence.luma.size(); ++i) {
    const hal::ImageView view = sequence.luma[i].view();
    const auto start = std::chrono::steady_clock::now();
    const ImageMotion& motion = estimator.follow(view.planes[0], view.format.size, i);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    if (i < 2) continue;
    out.milliseconds.push_back(took.count());
    ++out.frames;
    out.cuts += motion.isCut ? 1U : 0U;
    out.featuresPerFrame += static_cast<double>(motion.features.size());
    for (const FeatureMotion& feature : motion.features) {
      const auto there = sequence.moved(i - 1, glm::dvec2(feature.previous));
      if (!there) continue;
      out.features.add(glm::distance(glm::dvec2(feature.current), *there),
                       static_cast<double>(feature.errorPx));
    }
    if (motion.picture) {
      ++out.pictures;
      if (!sequence.homographies.empty()) {
        const glm::dmat3 apart =
            glm::inverse(sequence.homographies[i - 1]) * motion.picture->currentFromPrevious;
        out.picture.add(rmsMotion(apart, view.format.size), motion.picture->errorPx);
      }
    }
    const DenseFlow& flow = motion.flow;
    for (std::size_t n = 0; n < flow.forward.size(); ++n) {
      const int node = static_cast<int>(n);
      const glm::dvec2 px = glm::dvec2(flow.stepPx) *
                            (glm::dvec2(node % flow.nodes.width, node / flow.nodes.width) + 0.5);
      const auto there = sequence.moved(i - 1, px);
      if (!there || glm::any(glm::lessThan(*there, glm::dvec2(0.0))) ||
          glm::any(glm::greaterThan(*there,
                                    glm::dvec2(view.format.size.width, view.format.size.height)))) {
        continue;
      }
      const glm::vec4& found = flow.forward[n];
      out.flow.add(glm::distance(px + glm::dvec2(found), *there), static_cast<double>(found.z));
    }
  }
  out.featuresPerFrame /= static_cast<double>(std::max<std::size_t>(out.frames, 1));
  return out;
}

}  // namespace pleinair::tracking
