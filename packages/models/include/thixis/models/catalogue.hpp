#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thixis/models/entry.hpp"

namespace thixis::models {

/// What a program can do: its methods and its models, and with them the deck that it reads. It must outlive the decks.
class Catalogue {
 public:
  Catalogue(std::vector<method::Method> methods, std::vector<Family> families);
  Catalogue(const Catalogue&) = delete;
  Catalogue& operator=(const Catalogue&) = delete;

  const std::vector<method::Method>& methods() const { return methods_; }
  const std::vector<Family>& families() const { return families_; }
  const std::vector<Entry>& models() const { return models_; }  ///< of all families
  /// By their names in the deck. Throw InputError for others.
  const method::Method& method(const std::string& name) const;
  const Entry& model(const std::string& name) const;
  const Entry& model(const RunParams& params) const { return model(params.scene.model); }
  const method::Method& method(const RunParams& params) const { return method(params.method.name); }

  const core::Schema<RunParams>& schema() const { return schema_; }
  const core::Uses<RunParams>& uses() const { return uses_; }  ///< when the entries of a deck take part

  /// A deck that says nothing: the first model and the first method.
  RunParams defaults() const;
  /// The model that the deck asks for, with the method that it asks for. Throws InputError for what is wrong in the scene.
  std::unique_ptr<Model> make(const RunParams& params) const;
  /// A deck to start from for a model or a catalogued case: a mesh and a method that serve it, data where there is no case. Nothing if
  /// `name` is neither.
  std::optional<RunParams> starting(const std::string& name) const;

 private:
  std::vector<method::Method> methods_;
  std::vector<Family> families_;
  std::vector<Entry> models_;
  core::Schema<RunParams> schema_;
  core::Uses<RunParams> uses_;
};

}  // namespace thixis::models
