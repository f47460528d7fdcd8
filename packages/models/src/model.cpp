#include "thixis/models/model.hpp"

namespace thixis::models {

// The tables of virtual functions stand here, once.
SceneOnMesh::~SceneOnMesh() = default;
Model::~Model() = default;

}  // namespace thixis::models
