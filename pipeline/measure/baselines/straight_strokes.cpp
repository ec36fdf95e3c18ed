#include "pipeline/measure/baselines/straight_strokes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/measure/baselines/edge_tensors.h"

namespace pleinair::measure {
namespace {

double msSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

cv::Mat1f strengthsOf(const TensorImage& image) {
  cv::Mat1f strengths(image.size.height, image.size.width);
  for (std::size_t i = 0; i < image.tensors.size(); ++i) {
    strengths(static_cast<int>(i)) = static_cast<float>(glm::length(image.tensors[i]));
  }
  return strengths;
}

/// Along the edge: across the gradient, whose doubled angle the tensor is.
glm::dvec2 directionOf(glm::dvec2 tensor) {
  const double theta = 0.5 * std::atan2(tensor.y, tensor.x);
  return {-std::sin(theta), std::cos(theta)};
}

cv::Point pixelOf(glm::dvec2 px) {
  return {static_cast<int>(std::floor(px.x)), static_cast<int>(std::floor(px.y))};
}

/// How far a stroke may go until it meets an edge that it does not lie on.
double reach(const cv::Mat1f& strengths, glm::dvec2 from, glm::dvec2 way, double most,
             double threshold) {
  const double here = strengths(pixelOf(from));
  for (double along = 1.0; along < most; along += 1.0) {
    const glm::dvec2 at = from + along * way;
    const cv::Point px = pixelOf(at);
    if (!cv::Rect(cv::Point(), strengths.size()).contains(px)) return along;
    if (strengths(px) > std::max(threshold, 1.5 * here)) return along;
  }
  return most;
}

}  // namespace

StraightStrokePainting paintWithStraightStrokes(const hal::Image& image,
                                                const StraightStrokeOptions& options) {
  constexpr int kShift = 4;                // fractional bits of OpenCV's places
  constexpr double kDetailOfLayers = 0.6;  // of the image's mean
  const hal::FrameSize size = image.size();
  hal::Image copy(image.view());
  const cv::Mat3b source(size.height, size.width,
                         reinterpret_cast<cv::Vec3b*>(copy.plane(0).data()));
  const TensorImage gradients = gradientTensors(image.view());
  const cv::Mat1f strengths = strengthsOf(gradients);
  const double strongest = edgePercentile(gradients, 0.995);
  const double threshold = strongest / 3.0;
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);

  StraightStrokePainting painted{.picture = hal::Image(image.view())};
  cv::Mat3b canvas;
  cv::GaussianBlur(source, canvas, {}, options.finestPixels * 4.0);
  for (int layer = 0; layer < options.layers; ++layer) {
    const double width =
        options.finestPixels * std::pow(options.layerRatio, options.layers - 1 - layer);
    std::vector<glm::dvec2> places;
    for (double y = 0.0; y < size.height; y += width) {
      for (double x = 0.0; x < size.width; x += width) {
        // In this order: that of a call's arguments is the compiler's.
        const double down = unit(random);
        const glm::dvec2 at(x + width * unit(random), y + width * down);
        if (at.x < size.width && at.y < size.height) places.push_back(at);
      }
    }
    std::ranges::shuffle(places, random);
    cv::Mat1f detail;
    cv::GaussianBlur(strengths, detail, {}, 2.0 * width);
    const double least = kDetailOfLayers * cv::mean(detail)[0];
    if (layer > 0) {
      std::erase_if(places,
                    [&](const glm::dvec2& at) { return double{detail(pixelOf(at))} < least; });
    }
    const auto start = std::chrono::steady_clock::now();
    const std::vector<glm::dvec2> tensors =
        radialBasisTensors(gradients, threshold, options.sigmaPx, RadialBasis::kEq12, places);
    painted.fieldMs += msSince(start);

    const auto drawing = std::chrono::steady_clock::now();
    cv::Mat3b colours;
    cv::GaussianBlur(source, colours, {}, 0.5 * width);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const glm::dvec2 way = directionOf(tensors[i]);
      const double most = 0.5 * options.length * width;
      const double edge = options.edgePart * strongest;
      const glm::dvec2 from = places[i] - reach(strengths, places[i], -way, most, edge) * way;
      const glm::dvec2 to = places[i] + reach(strengths, places[i], way, most, edge) * way;
      const cv::Vec3b colour = colours(pixelOf(places[i]));
      const auto fixed = [&](glm::dvec2 px) {
        return cv::Point(static_cast<int>(std::lround(px.x * (1 << kShift))),
                         static_cast<int>(std::lround(px.y * (1 << kShift))));
      };
      cv::line(canvas, fixed(from), fixed(to), cv::Scalar(colour[0], colour[1], colour[2]),
               std::max(1, static_cast<int>(std::lround(width))), cv::LINE_AA, kShift);
      ++painted.strokes;
    }
    painted.drawMs += msSince(drawing);
  }
  canvas.copyTo(cv::Mat3b(size.height, size.width,
                          reinterpret_cast<cv::Vec3b*>(painted.picture.plane(0).data())));
  return painted;
}

}  // namespace pleinair::measure
