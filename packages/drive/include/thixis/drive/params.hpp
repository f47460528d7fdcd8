#pragma once
#include "thixis/models/catalogue.hpp"

namespace thixis::drive {

// The deck and its blocks, which the driver reads (thixis/models/params.hpp).
using models::AdaptParams;
using models::ExpectAtParams;
using models::ExpectParams;
using models::Marking;
using models::names_of_estimate;
using models::OutputParams;
using models::RunParams;
using models::TimeParams;
using models::TimeUnit;

}  // namespace thixis::drive
