#pragma once
#include "thixis/equilibration/cell_fields.hpp"

/// Functions and fluxes given cell by cell, in modal coefficients, as equilibration lays them out.
namespace thixis::bound {

using equilibration::CellTable;
using equilibration::ConstCellTable;
using equilibration::Matrix;
using equilibration::Metric;
using equilibration::Metrics;
using equilibration::metrics;
using mesh::View;

}  // namespace thixis::bound
