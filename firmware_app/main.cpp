#include "firmware_app/command_line.h"
#include "pipeline/gpu/frame_trial.h"
#include "pipeline/gpu/import_trial.h"

int main(int argc, char** argv) {
  // What this program starts itself as, where a driver might crash.
  if (const auto status = pleinair::gpu::runImportTrial(argc, argv)) return *status;
  if (const auto status = pleinair::gpu::runFrameTrial(argc, argv)) return *status;
  return pleinair::app::runCommandLine(argc, argv);
}
