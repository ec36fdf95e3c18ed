#include "firmware_app/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace pleinair::app {

void logToStandardError() {
  auto logger = std::make_shared<spdlog::logger>("pleinair",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("pleinair: %l: %v");
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace pleinair::app
