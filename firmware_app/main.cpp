#include "firmware_app/cli/command_line.h"

int main(int argc, char** argv) {
  return pleinair::app::runCommandLine(argc, argv);
}
