#include "firmware_app/command_line.h"

int main(int argc, char** argv) {
  return pleinair::app::runCommandLine(argc, argv);
}
