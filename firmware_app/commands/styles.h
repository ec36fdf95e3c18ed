#pragma once

namespace pleinair::app {

/// Lists the styles with their views and parameters: `pleinair styles`.
int listStyles();

}  // namespace pleinair::app
