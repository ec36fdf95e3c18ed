#pragma once

namespace pleinair::app {

/// Lists the styles with their looks, parameters and views, without a GPU: `pleinair styles`.
int listStyles();

}  // namespace pleinair::app
