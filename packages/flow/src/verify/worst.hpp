#pragma once
#include "thixis/fv/host.hpp"
#include "verify/findings.hpp"

namespace thixis::flow {

/// Takes a violation in, infinite where it is no number.
void see(FlowFindings::Worst& worst, double violation, GlobalIndex cell);

/// The worst cells of all ranks, the first of them where several are as bad. Collective.
void settle(const fv::Grid& grid, const fv::HostGrid& on_host, FlowFindings& found);

}  // namespace thixis::flow
