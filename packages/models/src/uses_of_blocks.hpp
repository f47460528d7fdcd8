#pragma once
#include "schemas.hpp"

namespace thixis::models {

/// Whether an entry that the model does not use may stand all the same: it says what is done anyhow, or its block is judged as a whole.
bool says_nothing(const RunParams& params, const std::string& path);

// When entries of a block take part, beside what models and methods say themselves.
void of_the_mesh(core::Uses<RunParams>& uses);
void of_the_method(core::Uses<RunParams>& uses, const Catalogue& catalogue);
void of_newton(core::Uses<RunParams>& uses, const Catalogue& catalogue);
void of_the_linear_solver(core::Uses<RunParams>& uses);
void of_stopping(core::Uses<RunParams>& uses, const Catalogue& catalogue);
void of_time(core::Uses<RunParams>& uses, const Catalogue& catalogue);

}  // namespace thixis::models
