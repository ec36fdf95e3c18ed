#pragma once

#include <vector>

#include "hal/clock.h"
#include "pipeline/runtime/capture_stage.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/output_stage.h"
#include "pipeline/runtime/paint_stage.h"

namespace pleinair::runtime {

/// A live chain at one moment.
struct RuntimeStatus {
  hal::Duration uptime{0};
  CaptureStage::Status camera;
  PaintStage::Status painting;
  std::vector<OutputStage::Status> outputs;
  LedgerCounts ledger;

  /// Whether pictures come out: the camera streams and every output takes pictures.
  bool isHealthy() const;
};

}  // namespace pleinair::runtime
