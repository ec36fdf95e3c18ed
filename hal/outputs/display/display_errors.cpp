#include "hal/outputs/display/display_errors.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace pleinair::hal::display {
namespace {

namespace fs = std::filesystem;

bool isNumber(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

bool hasOpen(const fs::path& process, const std::string& node) {
  std::error_code failure;
  for (fs::directory_iterator each(process / "fd", failure), end; !failure && each != end;
       each.increment(failure)) {
    std::error_code ignored;
    if (fs::read_symlink(each->path(), ignored) == node) return true;
  }
  return false;
}

}  // namespace

Error noCard(std::string subject) {
  return {.kind = ErrorKind::kNotFound,
          .subject = std::move(subject),
          .problem = "there is no graphics card (/dev/dri/card*)",
          .remedy = "load its driver; `pleinair doctor` says more"};
}

Error notMaster(const std::string& node, std::string subject) {
  const std::string users = usersText(node);
  return {.kind = ErrorKind::kBusy,
          .subject = std::move(subject),
          .problem = "another program shows pictures there" + (users.empty() ? "" : ": " + users),
          .remedy = "end it, or use a window on its desktop"};
}

std::string usersText(const std::string& node, const fs::path& proc) {
  std::string text;
  std::error_code failure;
  for (fs::directory_iterator each(proc, failure), end; !failure && each != end;
       each.increment(failure)) {
    const std::string process = each->path().filename().string();
    if (!isNumber(process) || process == std::to_string(::getpid())) continue;
    if (!hasOpen(each->path(), node)) continue;
    std::string name;
    std::getline(std::ifstream(each->path() / "comm") >> std::ws, name);
    text += (text.empty() ? "" : ", ") + (name.empty() ? "a program" : name) + " (" + process + ")";
  }
  return text;
}

}  // namespace pleinair::hal::display
