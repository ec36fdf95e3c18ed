#include "firmware_app/command_line.h"
#include "pipeline/gpu/import_trial.h"

int main(int argc, char** argv) {
  // The program starts itself anew for this trial, in which a driver may crash.
  if (const auto status = pleinair::gpu::runImportTrial(argc, argv)) return *status;
  return pleinair::app::runCommandLine(argc, argv);
}
