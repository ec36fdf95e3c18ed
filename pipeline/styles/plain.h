#pragma once

#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// Of the style "none": an empty list.
config::ParameterValues plainParameters();

/// The style "none": hands the AR frame's own picture through.
class Plain final : public Style {
 public:
  std::string_view name() const override { return "none"; }
  std::span<const DebugViewInfo> views() const override { return {}; }
  scene::ArFrameNeeds needs() const override { return {.shading = scene::Shading::kSmooth}; }
  const config::ParameterValues& parameters() const override { return values_; }
  void setParameters(const config::ParameterValues& values) override { values_ = values; }
  /// The frame's own texture; it is valid as long as the frame.
  const gpu::Texture& paint(const scene::ArFrame& frame, std::string_view view,
                            gpu::PassTimer& timer) override;
  void reset() override {}

 private:
  config::ParameterValues values_ = plainParameters();
};

}  // namespace pleinair::styles
