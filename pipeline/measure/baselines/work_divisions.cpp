#include "pipeline/measure/baselines/work_divisions.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "hal/median.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/measure/baselines/edge_tensors.h"

namespace pleinair::measure {
namespace {

const std::string kShaders = "pipeline/measure/baselines/shaders/";

std::size_t countOf(hal::FrameSize size) {
  return static_cast<std::size_t>(size.pixels());
}

std::span<const std::uint8_t> bytesOf(std::span<const float> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

std::vector<float> lumaOf(const hal::Image& image) {
  std::vector<float> luma;
  luma.reserve(countOf(image.size()));
  const hal::ImageView view = image.view();
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = view.row(0, y);
    for (std::size_t i = 0; i + 2 < row.size(); i += 3) {
      luma.push_back((0.299F * row[i] + 0.587F * row[i + 1] + 0.114F * row[i + 2]) / 255.0F);
    }
  }
  return luma;
}

double medianMs(int runs, const std::function<void()>& work) {
  work();
  glFinish();  // warmed up
  std::vector<double> times;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    glFinish();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
  }
  return hal::medianOf(times);
}

struct Way {
  const char* division;  // of tensor_work.glsl
  const char* text;
};
constexpr std::array<Way, 3> kWays{{{"ROWS", "row"}, {"COLUMNS", "column"}, {"PIXELS", "pixel"}}};

glm::ivec2 invocations(const Way& way, hal::FrameSize size) {
  if (way.division == kWays[0].division) return {size.height, 1};
  if (way.division == kWays[1].division) return {size.width, 1};
  return {size.width, size.height};
}

}  // namespace

std::vector<WorkDivision> timeWorkDivisions(const gpu::ShaderLibrary& library,
                                            const hal::Image& image, int runs) {
  const hal::FrameSize size = image.size();
  const hal::FrameSize half{size.width / 2, size.height / 2};
  const std::vector<float> luma = lumaOf(image);
  const gpu::Buffer lumaBuffer = gpu::Buffer::of(std::span<const float>(luma));
  gpu::Texture lumaTexture(gpu::TextureFormat::kR32f, size);
  lumaTexture.upload(bytesOf(luma), static_cast<std::size_t>(size.width) * sizeof(float));
  const TensorImage truth = gradientTensors(image.view());
  std::vector<float> four;
  std::vector<float> two;
  for (const glm::dvec2& each : truth.tensors) {
    two.insert(two.end(), {static_cast<float>(each.x), static_cast<float>(each.y)});
    four.insert(four.end(), {two[two.size() - 2], two.back(), 0.0F, 0.0F});
  }
  const gpu::Buffer tensorBuffer = gpu::Buffer::of(std::span<const float>(two));
  gpu::Texture tensorTexture(gpu::TextureFormat::kRgba32f, size);
  tensorTexture.upload(bytesOf(four), static_cast<std::size_t>(size.width) * 4 * sizeof(float));
  const gpu::Buffer made(countOf(size) * 2 * sizeof(float), gpu::BufferUsage::kDynamic);
  const gpu::Buffer level(countOf(half) * 2 * sizeof(float), gpu::BufferUsage::kDynamic);

  std::vector<WorkDivision> found;
  for (const Way& way : kWays) {
    for (const bool isTexture : {false, true}) {
      gpu::ShaderDefines defines{{way.division}};
      if (isTexture) defines.push_back({"TEXTURE"});
      gpu::Program gradient = library.compute(kShaders + "initial_tensor.comp", defines);
      gpu::Program mean = library.compute(kShaders + "mean_level.comp", defines);
      const glm::ivec2 sides(size.width, size.height);
      const auto makeTensors = [&] {
        gradient.use().storage("Tensors", made).set("size", sides);
        if (isTexture) {
          gradient.texture("luma", lumaTexture);
        } else {
          gradient.storage("Luma", lumaBuffer);
        }
        gradient.dispatch(invocations(way, size), GL_SHADER_STORAGE_BARRIER_BIT);
      };
      const auto makeLevel = [&] {
        mean.use().storage("Level", level).set("size", glm::ivec2(half.width, half.height));
        if (isTexture) {
          mean.texture("tensors", tensorTexture);
        } else {
          mean.storage("Below", tensorBuffer).set("belowWidth", size.width);
        }
        mean.dispatch(invocations(way, half), GL_SHADER_STORAGE_BARRIER_BIT);
      };
      WorkDivision each{.name = std::string(way.text) + (isTexture ? ", texture" : ", buffer"),
                        .gradientMs = medianMs(runs, makeTensors),
                        .levelMs = medianMs(runs, makeLevel)};
      std::vector<float> read(two.size());
      glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
      if (made.read(std::as_writable_bytes(std::span(read)))) {
        for (std::size_t i = 0; i < read.size(); ++i) {
          each.apart = std::max(each.apart, std::abs(double{read[i]} - double{two[i]}));
        }
      }
      const auto belowAt = [&](int x, int y, std::size_t part) {
        return double{two[2 * static_cast<std::size_t>(y * size.width + x) + part]};
      };
      std::vector<float> means(2 * countOf(half));
      if (level.read(std::as_writable_bytes(std::span(means)))) {
        for (int i = 0; i < half.width * half.height; ++i) {
          const int x = 2 * (i % half.width);
          const int y = 2 * (i / half.width);
          for (std::size_t part = 0; part < 2; ++part) {
            const double mean2x2 = 0.25 * (belowAt(x, y, part) + belowAt(x + 1, y, part) +
                                           belowAt(x, y + 1, part) + belowAt(x + 1, y + 1, part));
            each.apart =
                std::max(each.apart,
                         std::abs(double{means[2 * static_cast<std::size_t>(i) + part]} - mean2x2));
          }
        }
      }
      found.push_back(std::move(each));
    }
  }
  return found;
}

}  // namespace pleinair::measure
