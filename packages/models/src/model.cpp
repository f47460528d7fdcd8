#include "thixis/models/model.hpp"

#include "thixis/models/evolution.hpp"

namespace thixis::models {

// The tables of virtual functions stand here, once.
Discretization::~Discretization() = default;
Evolution::~Evolution() = default;
Model::~Model() = default;

}  // namespace thixis::models
