#pragma once

#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// The style "none": no parameters, looks or views.
const StyleKind& plainKind();

/// Hands the AR frame's own picture through.
class Plain final : public Style {
 public:
  const StyleKind& kind() const override { return plainKind(); }
  const config::ParameterValues& parameters() const override { return values_; }
  void setParameters(const config::ParameterValues& values) override { values_ = values; }
  /// The frame's own texture; it is valid as long as the frame.
  const gpu::Texture& paint(const scene::ArFrame& frame, std::string_view view) override;
  void reset() override {}

 private:
  config::ParameterValues values_ = plainKind().defaults;
};

}  // namespace pleinair::styles
