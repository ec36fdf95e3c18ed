#include "tests/reports/tracking/truth_sequence.h"

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/cameras/recording/recording.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/cameras/synthetic/world/bench_tags.h"
#include "pipeline/tracking/image/luma.h"
#include "tests/unit/tracking/desk_sequence.h"

namespace pleinair::tracking {
namespace {

using nlohmann::json;

const std::string kVirtualStem =
    std::string(PLEINAIR_SHARED_DATA) + "/sequences/virtual_camera/room_wide_IMG_1455_640x480";

hal::Image lumaOf(LumaConverter& converter, const hal::ImageView& image) {
  const hal::PlaneView luma = converter.convert(image);
  const hal::ImageView view{
      .format = {.pixelFormat = hal::PixelFormat::kGrey8, .size = image.format.size},
      .planes = {luma}};
  return hal::Image(view);
}

/// Calls `take` with each frame's number, luma and time.
void forEachFrame(hal::Camera& camera, std::size_t mostFrames,
                  const std::function<void(std::size_t, hal::Image, hal::TimePoint)>& take) {
  hal::orThrow(camera.start({}));
  LumaConverter converter;
  for (std::size_t i = 0; i < mostFrames; ++i) {
    const hal::NextFrame next = camera.next(hal::kNoDeadline);
    const auto* frame = std::get_if<hal::CapturedFrame>(&next);
    if (frame == nullptr) break;
    take(i, lumaOf(converter, frame->image.map().view()), frame->captureTime);
  }
  camera.stop();
}

bool isInside(const TagCornersPx& corners, hal::FrameSize size) {
  constexpr double kMarginPx = 6.0;
  return std::ranges::all_of(corners, [&](const glm::dvec2& px) {
    return px.x > kMarginPx && px.y > kMarginPx && px.x < size.width - kMarginPx &&
           px.y < size.height - kMarginPx;
  });
}

/// Finds the tags that are in the image, in sequences without occlusion.
void findVisible(TruthFrame& frame) {
  for (const auto& [id, corners] : frame.corners) {
    if (isInside(corners, frame.luma.size())) frame.visible.insert(id);
  }
}

glm::dmat3 matrix3(const json& rows) {
  glm::dmat3 out(1.0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      out[column][row] = rows.at(static_cast<std::size_t>(3 * row + column));
    }
  }
  return out;
}

/// The file's tag poses use solvePnP's square: x right, y up, z towards the viewer.
TagMarker virtualMarker(int id, double edgeMetres, const json& tag) {
  cv::Matx33d rotation;
  cv::Rodrigues(
      cv::Vec3d(tag.at("rvec_photo").at(0), tag.at("rvec_photo").at(1), tag.at("rvec_photo").at(2)),
      rotation);
  glm::dmat4 pose(1.0);
  for (int row = 0; row < 3; ++row) {
    pose[0][row] = rotation(row, 0);
    pose[1][row] = -rotation(row, 1);
    pose[2][row] = -rotation(row, 2);
    pose[3][row] = tag.at("tvec_photo_m").at(static_cast<std::size_t>(row));
  }
  return {.id = id, .edgeMetres = edgeMetres, .worldFromTag = pose};
}

/// Resamples the image to another focal length, about the same principal point.
hal::Image zoomed(const hal::Image& image, const glm::dvec2& scale, const glm::dvec2& centre) {
  hal::Image out(image.format());
  hal::Image from(image.view());
  const cv::Mat source(image.size().height, image.size().width, CV_8UC1, from.plane(0).data());
  cv::Mat target(source.size(), CV_8UC1, out.plane(0).data());
  const glm::dvec2 shift = centre - scale * centre;
  const cv::Matx23d affine(scale.x, 0.0, shift.x, 0.0, scale.y, shift.y);
  cv::warpAffine(source, target, affine, source.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return out;
}

}  // namespace

const TagMarker& TruthSequence::marker(int id) const {
  const auto found = std::ranges::find(markers, id, &TagMarker::id);
  assert(found != markers.end());
  return *found;
}

TruthSequence readDesk() {
  const DeskSequence desk = readDeskSequence();
  TruthSequence out{
      .name = "desk_6dof", .camera = desk.camera, .markers = desk.markers, .frames = {}};
  hal::SteppedClock clock;
  const auto movie = hal::openRecording(desk.moviePath, clock);
  forEachFrame(*movie, desk.frames.size(), [&](std::size_t i, hal::Image luma, hal::TimePoint t) {
    TruthFrame frame{.luma = std::move(luma),
                     .time = t,
                     .cameraFromWorld = desk.frames[i].cameraFromWorld,
                     .corners = desk.frames[i].corners};
    findVisible(frame);
    out.frames.push_back(std::move(frame));
  });
  return out;
}

bool hasVirtualCamera() {
  return std::filesystem::exists(kVirtualStem + ".mp4");
}

TruthSequence readVirtualCamera() {
  std::ifstream stream(kVirtualStem + ".gt.json");
  const json file = json::parse(stream);
  const json& frames = file.at("frames");
  const json& k = frames.at(0).at("K");
  constexpr double kHalfPixel = 0.5;  // the file's pixel centres are at integers
  const glm::dvec2 focal(k.at(0), k.at(4));
  const glm::dvec2 centre(k.at(2), k.at(5));
  TruthSequence out{.name = "virtual_camera",
                    .camera = {{.fx = focal.x,
                                .fy = focal.y,
                                .cx = centre.x + kHalfPixel,
                                .cy = centre.y + kHalfPixel},
                               {},
                               {file.at("width"), file.at("height")}},
                    .markers = {},
                    .frames = {}};
  for (const auto& [id, tag] : frames.at(0).at("tags").items()) {
    out.markers.push_back(virtualMarker(std::stoi(id), file.at("tag_size_m"), tag));
  }
  hal::SteppedClock clock;
  const auto movie = hal::openRecording(kVirtualStem + ".mp4", clock);
  forEachFrame(*movie, frames.size(), [&](std::size_t i, const hal::Image& luma, hal::TimePoint t) {
    const json& of = frames.at(i);
    const glm::dvec2 scale = focal / glm::dvec2(of.at("K").at(0), of.at("K").at(4));
    TruthFrame frame{.luma = zoomed(luma, scale, centre),
                     .time = t,
                     .cameraFromWorld = glm::dmat4(matrix3(of.at("R_photo_to_cam")))};
    for (const auto& [id, tag] : of.at("tags").items()) {
      TagCornersPx& corners = frame.corners[std::stoi(id)];
      for (std::size_t c = 0; c < 4; ++c) {
        const json& point = tag.at("corners_px_tl_tr_br_bl").at(3 - c);
        const glm::dvec2 px(point.at(0), point.at(1));
        corners[c] = centre + scale * (px - centre) + kHalfPixel;
      }
    }
    findVisible(frame);
    out.frames.push_back(std::move(frame));
  });
  return out;
}

TruthSequence filmWorkbench(const WorkbenchTake& take) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera({.size = take.size, .shot = take.shot, .noiseSigma = take.noiseSigma},
                              clock);
  const hal::PinholeIntrinsics k = hal::syntheticIntrinsics(take.size);
  TruthSequence out{.name = "workbench " + std::string(toString(take.shot)),
                    .camera = {{.fx = k.fx, .fy = k.fy, .cx = k.cx, .cy = k.cy}, {}, take.size},
                    .markers = {},
                    .frames = {}};
  for (const hal::BenchTag& tag : hal::benchTags()) {
    out.markers.push_back(
        {.id = tag.id, .edgeMetres = tag.edgeMetres, .worldFromTag = tag.worldFromTag});
  }
  forEachFrame(camera, take.frameCount, [&](std::size_t i, hal::Image luma, hal::TimePoint t) {
    const hal::GroundTruth truth = camera.truth(i);
    TruthFrame frame{.luma = std::move(luma), .time = t, .cameraFromWorld = truth.cameraFromWorld};
    for (const hal::TagTruth& tag : truth.tags) {
      frame.corners[tag.tag.id] = tag.cornersPx;
      if (tag.isVisible) frame.visible.insert(tag.tag.id);
    }
    out.frames.push_back(std::move(frame));
  });
  return out;
}

}  // namespace pleinair::tracking
