#include "tests/unit/tracking/desk_sequence.h"

#include <array>
#include <filesystem>
#include <fstream>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <nlohmann/json.hpp>

namespace pleinair::tracking {
namespace {

using nlohmann::json;

const std::string kStem =
    std::string(PLEINAIR_SHARED_DATA) + "/sequences/desk_6dof/planar6dof_720p_slow";

/// The file lists corners as in the library's own image: top left, top right, bottom right, bottom
/// left. (The desk was drawn with OpenCV's images, which are rotated by 180°; the file accounts for
/// that.) tagCorners() begins at the bottom left and goes the other way round.
constexpr std::array<std::size_t, 4> kFileCornerOf{3, 2, 1, 0};

CameraModel readCamera(const json& file) {
  const json& k = file.at("K");
  constexpr double kHalfPixel = 0.5;  // the file's pixel centres are at integers
  return {{.fx = k.at(0),
           .fy = k.at(4),
           .cx = k.at(2).get<double>() + kHalfPixel,
           .cy = k.at(5).get<double>() + kHalfPixel},
          {},
          {file.at("width"), file.at("height")}};
}

/// The frame of a flat square, from its corners.
TagMarker readMarker(int id, const json& tag) {
  std::array<glm::dvec3, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    const json& point = tag.at("corners_world_m").at(kFileCornerOf[i]);
    corners[i] = {point.at(0), point.at(1), point.at(2)};
  }
  const glm::dvec3 x = glm::normalize(corners[1] - corners[0]);
  const glm::dvec3 y = glm::normalize(corners[0] - corners[3]);
  const glm::dvec3 centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
  return {.id = id,
          .edgeMetres = tag.at("size_m"),
          .worldFromTag = glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(y, 0.0),
                                     glm::dvec4(glm::cross(x, y), 0.0), glm::dvec4(centre, 1.0))};
}

DeskSequence::Frame readFrame(const json& file) {
  DeskSequence::Frame frame;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      frame.cameraFromWorld[column][row] =
          file.at("R_world_to_cam").at(static_cast<std::size_t>(3 * row + column));
    }
    frame.cameraFromWorld[3][row] = file.at("t_world_to_cam").at(static_cast<std::size_t>(row));
  }
  for (const auto& [id, points] : file.at("tag_corners_px_tl_tr_br_bl").items()) {
    TagCornersPx& corners = frame.corners[std::stoi(id)];
    for (std::size_t i = 0; i < 4; ++i) {
      const json& point = points.at(kFileCornerOf[i]);
      corners[i] = {point.at(0).get<double>() + 0.5, point.at(1).get<double>() + 0.5};
    }
  }
  return frame;
}

}  // namespace

bool hasDeskSequence() {
  return std::filesystem::exists(kStem + ".mp4") && std::filesystem::exists(kStem + ".gt.json");
}

DeskSequence readDeskSequence() {
  std::ifstream stream(kStem + ".gt.json");
  const json file = json::parse(stream);
  DeskSequence desk{
      .moviePath = kStem + ".mp4", .camera = readCamera(file), .markers = {}, .frames = {}};
  for (const auto& [id, tag] : file.at("tags").items()) {
    desk.markers.push_back(readMarker(std::stoi(id), tag));
  }
  for (const json& frame : file.at("frames")) desk.frames.push_back(readFrame(frame));
  return desk;
}

}  // namespace pleinair::tracking
