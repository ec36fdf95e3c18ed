// pleinair-libcamera: serves libcamera to the program that has started it.

#include "hal/cameras/libcamera/host_process.h"

int main() {
  return pleinair::hal::libcamera::runHost();
}
