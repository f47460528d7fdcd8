#pragma once
#include <type_traits>

#include "thixis/core/description.hpp"
#include "thixis/core/extras.hpp"

namespace thixis::core {

namespace detail {
template <class T>
struct Strip {
  using type = T;
  static constexpr bool optional = false;
};
template <class T>
struct Strip<std::optional<T>> {
  using type = T;
  static constexpr bool optional = true;
};
template <class T>
struct Same {
  using type = T;
};

template <class T>
constexpr Description::Kind kind_of() {
  using Kind = Description::Kind;
  if constexpr (std::is_same_v<T, bool>) return Kind::boolean;
  else if constexpr (std::is_same_v<T, int>) return Kind::integer;
  else if constexpr (std::is_same_v<T, long long>) return Kind::long_integer;
  else if constexpr (std::is_same_v<T, double>) return Kind::real;
  else if constexpr (std::is_same_v<T, std::string>) return Kind::text;
  else if constexpr (std::is_same_v<T, Formula>) return Kind::formula;
  else if constexpr (std::is_same_v<T, std::vector<double>>) return Kind::reals;
  else if constexpr (std::is_same_v<T, std::vector<int>>) return Kind::integers;
  else {
    static_assert(std::is_same_v<T, std::vector<std::string>>, "a parameter of the deck can not have this type");
    return Kind::texts;
  }
}
template <class T>
Description::Value to_value(const T& x) {
  if constexpr (std::is_same_v<T, int>) return static_cast<long long>(x);
  else if constexpr (std::is_same_v<T, Formula>) return x.text;
  else return x;
}
template <class T>
T from_value(const Description::Value& value) {
  if constexpr (std::is_same_v<T, int>) return static_cast<int>(std::get<long long>(value));
  else if constexpr (std::is_same_v<T, Formula>) return Formula{std::get<std::string>(value)};
  else return std::get<T>(value);
}
}  // namespace detail

/// One block of the deck, described once, next to the struct P that it fills. From it come the reader, `thixis describe`, the reference
/// page and the sentences of the errors. Defaults are those of `defaults`; they must be allowed themselves (core::Error if not), but an
/// empty array or text stands for "not given" where an empty one is not allowed.
///
///     static const auto s = core::Schema<NewtonParams>("newton", "How the nonlinear system is solved.")
///         .parameter("max iterations", &NewtonParams::max_iterations, core::at_least(0), "Newton steps after which the run gives up.")
///         .choice("c-function", &NewtonParams::c_function, {{"min", CFunction::min}}, "Function whose zeros are the contact conditions.")
///         .block("initial", &NewtonParams::initial, InitialParams::schema());
///
/// Members are bool, int, long long, double, std::string, Formula, std::vector of double, int or std::string, or a std::optional of those.
template <class P>
class Schema {
 public:
  Schema(const std::string& name, const std::string& sentence, const P& defaults = P())
      : description_(std::make_shared<Description>(name, sentence,
                                                   [defaults] { return std::static_pointer_cast<void>(std::make_shared<P>(defaults)); })) {}

  /// A schema of its own, which may be added to.
  Schema(const Schema& other) : description_(std::make_shared<Description>(*other.description_)) {}
  Schema& operator=(const Schema&) = delete;

  template <class M, class B>
  Schema& parameter(const std::string& name, M B::*member, const Range& range, const std::string& sentence) {
    using T = typename detail::Strip<M>::type;
    Description::Parameter p = entry(name, detail::kind_of<T>(), range, sentence);
    p.set = [member](void* object, const Description::Value& value) { static_cast<P*>(object)->*member = detail::from_value<T>(value); };
    p.get = [member](const void* object) { return value_of(static_cast<const P*>(object)->*member); };
    description_->add(std::move(p));
    return *this;
  }
  template <class M, class B>
  Schema& parameter(const std::string& name, M B::*member, const std::string& sentence) {
    return parameter(name, member, Range{}, sentence);
  }

  /// A parameter with named values, type="string" in the deck; the member is an enum (or anything with ==), or a std::optional of one.
  template <class M, class B>
  Schema& choice(const std::string& name, M B::*member,
                 typename detail::Same<std::vector<std::pair<std::string, typename detail::Strip<M>::type>>>::type values,
                 const std::string& sentence) {
    Range range;
    for (const auto& value : values) range.names.push_back(value.first);
    Description::Parameter p = entry(name, Description::Kind::text, range, sentence);
    p.set = [member, values](void* object, const Description::Value& value) {
      for (const auto& [text, meaning] : values)
        if (text == std::get<std::string>(value)) static_cast<P*>(object)->*member = meaning;
    };
    p.get = [member, values](const void* object) -> std::optional<Description::Value> {
      for (const auto& [text, meaning] : values)
        if (static_cast<const P*>(object)->*member == meaning) return text;
      return std::nullopt;
    };
    description_->add(std::move(p));
    return *this;
  }

  /// A sublist that fills the struct Q; of a std::optional<Q> it says by its presence that there is one.
  template <class M, class B, class Q>
  Schema& block(const std::string& name, M B::*member, const Schema<Q>& schema, const std::string& sentence = "") {
    static_assert(std::is_same_v<typename detail::Strip<M>::type, Q>, "the schema describes another struct than the member");
    Description::Block b = sublist(name, sentence.empty() ? schema.description().sentence() : sentence, schema.shared());
    b.always = !detail::Strip<M>::optional;
    b.open = [member](void* object, const std::string&) -> void* {
      M& inside = static_cast<P*>(object)->*member;
      if constexpr (detail::Strip<M>::optional) {
        if (!inside) inside.emplace();
        return &*inside;
      } else {
        return &inside;
      }
    };
    b.members = [member, name](const void* object) {
      std::vector<std::pair<std::string, const void*>> found;
      const M& inside = static_cast<const P*>(object)->*member;
      if constexpr (detail::Strip<M>::optional) {
        if (inside) found.emplace_back(name, &*inside);
      } else {
        found.emplace_back(name, &inside);
      }
      return found;
    };
    description_->add(std::move(b));
    return *this;
  }

  /// A sublist of sublists with free names (boundary tags), each of which fills a struct Q.
  template <class B, class Q>
  Schema& blocks(const std::string& name, std::map<std::string, Q> B::*member, const Schema<Q>& schema, const std::string& sentence = "") {
    Description::Block b = sublist(name, sentence.empty() ? schema.description().sentence() : sentence, schema.shared());
    named(b, member);
    description_->add(std::move(b));
    return *this;
  }

  /// A sublist of parameters with free names (constants), all of one type.
  template <class B, class T>
  Schema& values(const std::string& name, std::map<std::string, T> B::*member, const Range& range, const std::string& sentence) {
    Description::Block b = sublist(name, sentence, nullptr);
    b.value = entry("", detail::kind_of<T>(), range, sentence);
    b.value->set = [](void* object, const Description::Value& value) { *static_cast<T*>(object) = detail::from_value<T>(value); };
    b.value->get = [](const void* object) { return value_of(*static_cast<const T*>(object)); };
    named(b, member);
    description_->add(std::move(b));
    return *this;
  }
  template <class B, class T>
  Schema& values(const std::string& name, std::map<std::string, T> B::*member, const std::string& sentence) {
    return values(name, member, Range{}, sentence);
  }

  /// The parameters, sublists and checks of a struct Q in the `extras` of P, as if they were those of P.
  template <class B, class Q>
  Schema& with(Extras B::*extras, const Schema<Q>& more) {
    description_->adopt(
        more.description(), [extras](void* object) -> void* { return &(static_cast<P*>(object)->*extras).template get<Q>(); },
        [extras](const void* object) -> const void* { return &(static_cast<const P*>(object)->*extras).template get<Q>(); });
    return *this;
  }

  /// The parameter or block added last must be given.
  Schema& required() {
    description_->require_last();
    return *this;
  }
  /// The parameter added last belongs into a deck to start from (describe as xml), with the first of its names, though it may be left out.
  Schema& exemplary() {
    description_->show_last();
    return *this;
  }
  /// What no single parameter shows. Runs after the block is read, even if parts of it are wrong (those keep their defaults).
  Schema& check(const std::function<void(const P&, Problems&)>& f) {
    description_->add_check([f](const void* object, Problems& problems) { f(*static_cast<const P*>(object), problems); });
    return *this;
  }

  const Description& description() const { return *description_; }
  std::shared_ptr<const Description> shared() const { return description_; }

 private:
  static Description::Parameter entry(const std::string& name, Description::Kind kind, const Range& range, const std::string& sentence) {
    Description::Parameter p;
    p.name = name, p.kind = kind, p.range = range, p.sentence = sentence;
    return p;
  }
  static Description::Block sublist(const std::string& name, const std::string& sentence, std::shared_ptr<const Description> inside) {
    Description::Block b;
    b.name = name, b.sentence = sentence, b.inside = std::move(inside);
    return b;
  }
  template <class M>
  static std::optional<Description::Value> value_of(const M& member) {
    if constexpr (detail::Strip<M>::optional) {
      if (!member) return std::nullopt;
      return detail::to_value(*member);
    } else {
      return detail::to_value(member);
    }
  }
  template <class B, class T>
  static void named(Description::Block& b, std::map<std::string, T> B::*member) {
    b.single = b.always = false;
    b.open = [member](void* object, const std::string& key) -> void* { return &(static_cast<P*>(object)->*member)[key]; };
    b.members = [member](const void* object) {
      std::vector<std::pair<std::string, const void*>> found;
      for (const auto& [key, value] : static_cast<const P*>(object)->*member) found.emplace_back(key, &value);
      return found;
    };
  }
  std::shared_ptr<Description> description_;
};

/// The whole deck of `params` with all defaults filled in; reading it gives equal `params`.
std::string to_xml(const Description& root, const void* params);
template <class P>
std::string to_xml(const Schema<P>& schema, const P& params) {
  return to_xml(schema.description(), &params);
}

/// Every parameter of the block at `path` ("" is the whole deck, "newton/initial" a block in a block) and of the blocks in it: type,
/// default, range, one sentence. `xml` is a deck that can be read: outside of the block it holds required parameters only. Throws
/// InputError if there is no such block.
std::string describe(const Description& root, const std::string& path, Format format);
template <class P>
std::string describe(const Schema<P>& schema, const std::string& path, Format format) {
  return describe(schema.description(), path, format);
}

}  // namespace thixis::core
