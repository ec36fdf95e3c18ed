#pragma once

#include <cstddef>
#include <string>

namespace pleinair::runtime {

/// Where the procedure stands that is carried out beside the painting.
struct ProcedureStatus {
  std::string name;
  std::string version;
  std::string step;        ///< its id; "end" at the end
  std::size_t number = 0;  ///< of the step, from 1; 0 at the end
  std::size_t steps = 0;
  std::string record;  ///< its file; empty: nothing is recorded
  bool isSignedOff = false;
};

}  // namespace pleinair::runtime
