#pragma once
#include "thixis/drive/params.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::drive {

/// Refuses a restart with another model, case, mesh or method, or with a start that it does not look at: names every parameter that must
/// stay what it was. Throws InputError.
void check_unchanged(const output::StoredCheckpoint& stored, const RunParams& params);

}  // namespace thixis::drive
