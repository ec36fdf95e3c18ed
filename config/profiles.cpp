#include "config/profiles.h"

namespace pleinair::config {

std::vector<std::string> profileNames() {
  std::vector<std::string> names;
  for (const Profile& profile : profiles()) names.emplace_back(profile.name);
  return names;
}

}  // namespace pleinair::config
