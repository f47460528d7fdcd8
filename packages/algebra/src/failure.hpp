#pragma once
#include <exception>
#include <optional>
#include <string>

#include "thixis/core/comm.hpp"

namespace thixis::algebra {

/// What a library says in an exception, in one line of at most 200 characters, without the place in its sources and the condition that
/// failed.
std::string said_by(const std::exception& exception);

/// If any rank brings what its library said: every rank throws Breakdown "<failure>: <what the lowest such rank brings>". Collective.
void break_down_together(const core::Comm& comm, const std::string& failure, const std::optional<std::string>& said);

}  // namespace thixis::algebra
