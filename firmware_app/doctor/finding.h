#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pleinair::app::doctor {

enum class Verdict {
  kOk,
  kWarning,  ///< it works, or only a part that not everybody uses does not
  kWrong,
};
std::string_view toString(Verdict verdict);  ///< "ok", "warning", "wrong"

/// The result of one check.
struct Finding {
  std::string check;  ///< "OpenGL ES"
  Verdict verdict = Verdict::kOk;
  std::string text;    ///< one line
  std::string remedy;  ///< the command that fixes it, or what to do; empty where all is well
};

/// A line a finding, and under each that is not well what fixes it; then how many.
std::string asText(const std::vector<Finding>& findings);
/// {"checks": [{"check", "verdict", "text", "remedy"} …], "wrong": n, "warnings": n}
std::string asJson(const std::vector<Finding>& findings);

}  // namespace pleinair::app::doctor
