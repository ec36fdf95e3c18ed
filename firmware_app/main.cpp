#include <malloc.h>

#include "firmware_app/command_line.h"
#include "pipeline/gpu/frames/import_trial.h"

int main(int argc, char** argv) {
  // A thread that finds all heaps in use makes one more, up to eight a processor, and each keeps
  // the most that it ever held: memory would grow for hours.
  mallopt(M_ARENA_MAX, 2);  // NOLINT(concurrency-mt-unsafe): there is no other thread yet
  // The program starts itself anew for this trial, in which a driver may crash.
  if (const auto status = pleinair::gpu::runImportTrial(argc, argv)) return *status;
  return pleinair::app::runCommandLine(argc, argv);
}
