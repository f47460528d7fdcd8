#pragma once
#include <array>
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"

namespace thixis::output {

/// Writes `probes.csv`: the header `x,y,<fields>`, then a line for each point; `values` [point][field]. Numbers read back as they were. At
/// any moment either the old or the new file is there. Collective; throws FileError on all ranks.
void write_probes(const std::string& path, const std::vector<std::array<double, 2>>& points, const std::vector<std::string>& fields,
                  const std::vector<double>& values, const core::Comm& comm);

}  // namespace thixis::output
