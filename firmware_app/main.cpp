#include "firmware_app/command_line.h"
#include "pipeline/gpu/import_trial.h"

int main(int argc, char** argv) {
  // What this program starts itself as, since a driver might crash there.
  if (const auto status = pleinair::gpu::runImportTrial(argc, argv)) return *status;
  return pleinair::app::runCommandLine(argc, argv);
}
