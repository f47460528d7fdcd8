#pragma once
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/schema.hpp"

namespace thixis::core {

/// A deck: Teuchos XML, read strictly. Nothing is interpreted before `parse`, which reports every mistake at once.
class Deck {
 public:
  /// Collective: the root reads the file. Throws FileError if it can not be read, InputError if it is no XML or holds no parameter list.
  static Deck read(const std::string& path, const Comm& comm = Comm());
  /// The same for a text in memory; `name` stands in the messages, `folder` is where relative paths in it start (empty: the folder of
  /// `name`). Not collective.
  static Deck from_text(const std::string& text, const std::string& name, const std::string& folder = "");

  /// Overrides one parameter: "method/degree=3", an array as "mesh/lower={0,0}". Missing blocks are created; the type is the schema's, and
  /// mistakes show in `parse`. The last one wins. Throws InputError if there is no path or no '='.
  void set(const std::string& assignment);

  /// The struct that the deck describes. Throws InputError with one line per mistake, in the order of the lines:
  /// "inputs/x.xml:14: newton/max iteration: no such parameter. Did you mean 'max iterations'?"
  template <class P>
  P parse(const Schema<P>& schema) const {
    P params = *std::static_pointer_cast<P>(schema.description().make());
    fill(schema.description(), &params);
    return params;
  }

  /// The error of a value that shows only later: "<file>:<line>: <path>: <sentence>" with the line of the nearest entry that is given.
  InputError error(const std::string& path, const std::string& sentence) const;
  /// The same error with file and line in front of every line that begins with the path of an entry in a block that is given: "mesh/file:
  /// ..." becomes "inputs/x.xml:9: mesh/file: ...". For what shows only later, thrown where the deck is not at hand.
  Error located(const Error& error) const;
  /// Whether the parameter or block at `path` is given.
  bool given(const std::string& path) const;

  const std::string& file() const { return file_; }  ///< as given to `read`
  std::string folder()
      const;                 ///< where relative paths in the deck start: the folder of the file ("." for the current one) or the given one
  std::string stem() const;  ///< the file's name without folder and extension

  /// An entry of the deck: <ParameterList> or <Parameter>.
  struct Entry {
    std::string name;
    bool list = false;
    std::string type, value;  ///< of a parameter; no type: given by --set
    bool complete = true;     ///< of a parameter: has a type and a value; otherwise that is among the mistakes
    int line = 0;
    int assignment = -1;  ///< the number of the --set that made it, or -1
    std::vector<Entry> inside;
    const Entry* find(const std::string& member, bool is_list) const;
    /// The entry at a path relative to this list, or the innermost given one on the way (then `exact` becomes false).
    const Entry& along(const std::string& path, bool& exact) const;
  };
  /// A mistake of form (unknown element, missing attribute, duplicate), found while reading.
  struct Mistake {
    int line = 0;
    int assignment = -1;
    std::string path, sentence;
  };

 private:
  void fill(const Description& description, void* params) const;
  std::string message(const Mistake& mistake) const;

  std::string file_, folder_;
  Entry root_;
  std::vector<std::string> assignments_;
  std::vector<Mistake> mistakes_;
};

}  // namespace thixis::core
