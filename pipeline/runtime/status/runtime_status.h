#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/machine/machine_state.h"
#include "pipeline/runtime/capture/capture_stage.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/output/output_stage.h"
#include "pipeline/runtime/paint/paint_stage.h"
#include "pipeline/runtime/status/procedure_status.h"

namespace pleinair::runtime {

/// A copy of a live pipeline's state.
struct RuntimeStatus {
  hal::Duration uptime{0};
  CaptureStage::Status camera;
  PaintStage::Status painting;
  std::vector<OutputStage::Status> outputs;
  LedgerCounts ledger;
  std::string siteOrigin;   ///< where the configuration in force came from; empty: not known
  std::string siteProblem;  ///< what is wrong with it, as it is shown; empty: nothing
  std::optional<hal::MachineState> machine;  ///< as of the last reading
  std::optional<ProcedureStatus> procedure;  ///< where one is carried out

  /// Whether the camera streams, there is a painter, and every output takes frames or is
  /// suspended.
  bool isHealthy() const;
};

}  // namespace pleinair::runtime
