#pragma once
#include <memory>

#include "thixis/drive/params.hpp"
#include "thixis/models/model.hpp"

namespace thixis {

/// The model that the deck asks for, with the method that it asks for. Throws InputError for what is wrong in the scene or not served.
std::unique_ptr<models::Model> make_model(const drive::RunParams& params);

}  // namespace thixis
