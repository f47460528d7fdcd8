#include "thixis/core/deck.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "scene/sample.hpp"
#include "thixis/core/error.hpp"
#include "thixis/membranes/family.hpp"
#include "thixis/membranes/scene.hpp"
#include "thixis/models/catalogue.hpp"

namespace thixis::membranes {
namespace {

using scene::FieldPtr;
using scene::ring;
using scene::Sample;

std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

models::SceneParams smooth_contact_data() {
  models::SceneParams params{model::two, {}, {}};
  of(params).data.emplace();
  DataParams& data = *of(params).data;
  data.centre = {0.5, 0.5};
  data.constants = {{"R", 1.0 / 3}, {"N", 6}};
  data.u1.text = "r < R ? 0 : (r^2 - R^2)^N";
  data.u2.text = "r < R ? 0 : -(r^2 - R^2)^N";
  data.lambda.text = "r < R ? 1000*r^3*(R^2 - r^2)^3 : 0";
  data.f1.text = "r < R ? -1000*r^3*(R^2 - r^2)^3 : -4*N*(r^2 - R^2)^(N-2)*(N*r^2 - R^2)";
  data.f2.text = "r < R ? 1000*r^3*(R^2 - r^2)^3 : 4*N*(r^2 - R^2)^(N-2)*(N*r^2 - R^2)";
  of(params).interface.text = "r - R";
  return params;
}

models::SceneParams by_height(const std::string& g1, const std::string& g2) {
  models::SceneParams params{model::two, {}, {}};
  of(params).data.emplace();
  of(params).data->g1.text = g1;
  of(params).data->g2.text = g2;
  return params;
}

TEST(MembraneScene, from_expressions_equals_the_catalogued_one) {
  models::SceneParams params{model::two, {}, {}};
  params.case_name = "smooth contact";
  const MembraneScene catalogued = membrane_scene(params), given = membrane_scene(smooth_contact_data());
  const Sample sample = ring(0.5, 0.5, 0, 0.7, 2000);
  const auto expect_equal = [&](const FieldPtr& a, const FieldPtr& b, double tolerance) {
    const auto left = sample(a), right = sample(b);
    for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], tolerance);
  };
  expect_equal(given.interface_level_set, catalogued.interface_level_set, 1e-15);
  expect_equal(given.exact->multiplier, catalogued.exact->multiplier, 1e-14);
  for (const int alpha : {0, 1}) {
    expect_equal(given.force[alpha], catalogued.force[alpha], 1e-14);
    expect_equal(given.exact->u[alpha], catalogued.exact->u[alpha], 1e-15);
    expect_equal(given.default_boundary.value[alpha], catalogued.default_boundary.value[alpha], 1e-15);
    for (const int direction : {0, 1}) EXPECT_EQ(given.exact->gradient[alpha][direction], nullptr);  // not given
  }
}

TEST(MembraneScene, takes_the_interface_of_the_deck_with_the_constants_of_the_case) {
  models::SceneParams params{model::two, {}, {}};
  params.case_name = "disk";
  of(params).interface.text = "2*(r - R)";
  Sample sample;
  sample.add(0, 1);
  EXPECT_NEAR(sample(membrane_scene(params).interface_level_set)[0], 2 * (1 - std::sqrt(0.5)), 1e-15);
}

TEST(MembraneScene, has_defaults_for_what_the_deck_leaves_out) {
  const MembraneScene scene = membrane_scene(by_height("1", "x - 1"));
  EXPECT_EQ(*scene.tension[0]->constant(), 1);
  EXPECT_EQ(*scene.force[1]->constant(), 0);
  EXPECT_EQ(*scene.default_boundary.value[0]->constant(), 1);
  EXPECT_FALSE(scene.exact);
  EXPECT_EQ(scene.interface_level_set, nullptr);
}

TEST(MembraneScene, has_conditions_by_boundary_tag) {
  models::SceneParams params = by_height("1", "0");
  of(params).boundary["wall"].g1.text = "2";
  of(params).boundary["free"].kind = BoundaryKind::neumann;
  of(params).boundary["free"].t2.text = "-3";
  const MembraneScene scene = membrane_scene(params);
  EXPECT_EQ(*scene.boundary.at("wall").value[0]->constant(), 2);
  EXPECT_EQ(*scene.boundary.at("wall").value[1]->constant(), 0);
  EXPECT_EQ(scene.boundary.at("free").kind, BoundaryKind::neumann);
  EXPECT_EQ(*scene.boundary.at("free").value[0]->constant(), 0);
  EXPECT_EQ(*scene.boundary.at("free").value[1]->constant(), -3);
}

TEST(MembraneScene, leaves_the_other_parts_without_condition_if_only_tagged_ones_are_given) {
  models::SceneParams params = by_height("", "");
  of(params).boundary["wall"].g1.text = "2";
  of(params).boundary["wall"].g2.text = "1";
  const MembraneScene scene = membrane_scene(params);
  EXPECT_EQ(*scene.boundary.at("wall").value[1]->constant(), 1);
  EXPECT_EQ(scene.default_boundary.value[0], nullptr);
}

models::SceneParams over_obstacle(const std::string& psi, const std::string& g) {
  models::SceneParams params{model::two, {}, {}};
  params.model = "obstacle";
  of(params).data.emplace();
  of(params).data->psi.text = psi;
  of(params).data->g.text = g;
  return params;
}

TEST(MembraneScene, over_an_obstacle_from_expressions_equals_the_catalogued_one) {
  models::SceneParams params{model::two, {}, {}};
  params.model = "obstacle";
  params.case_name = "radial obstacle";
  const MembraneScene catalogued = membrane_scene(params);
  params = over_obstacle("0.5 - r^2", "");
  of(params).data->constants = {{"R", 0.6}};
  of(params).data->u.text = "r < R ? 0.5 - r^2 : 0.5 - R^2 - 2*R^2*ln(r/R)";
  of(params).data->lambda.text = "r < R ? 4 : 0";
  of(params).interface.text = "r - R";
  const MembraneScene given = membrane_scene(params);
  EXPECT_EQ(given.count, 1);
  EXPECT_EQ(given.tension[1], nullptr);
  EXPECT_EQ(given.force[1], nullptr);
  EXPECT_EQ(given.exact->u[1], nullptr);
  const Sample sample = ring(0, 0, 0.01, 1, 2000);
  const auto expect_equal = [&](const FieldPtr& a, const FieldPtr& b, double tolerance) {
    const auto left = sample(a), right = sample(b);
    for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], tolerance);
  };
  expect_equal(given.obstacle, catalogued.obstacle, 1e-15);
  expect_equal(given.interface_level_set, catalogued.interface_level_set, 1e-15);
  expect_equal(given.tension[0], catalogued.tension[0], 0);
  expect_equal(given.force[0], catalogued.force[0], 0);
  expect_equal(given.exact->u[0], catalogued.exact->u[0], 1e-15);
  expect_equal(given.exact->multiplier, catalogued.exact->multiplier, 0);
  expect_equal(given.default_boundary.value[0], catalogued.default_boundary.value[0], 1e-15);
  for (const int direction : {0, 1}) EXPECT_EQ(given.exact->gradient[0][direction], nullptr);  // not given
}

TEST(MembraneScene, over_an_obstacle_has_conditions_by_boundary_tag) {
  models::SceneParams params = over_obstacle("-1 - x", "0.5");
  of(params).data->mu.text = "2";
  of(params).boundary["wall"].g.text = "3";
  of(params).boundary["rest"].kind = BoundaryKind::dirichlet;
  of(params).boundary["pulled"].kind = of(params).boundary["free"].kind = BoundaryKind::neumann;
  of(params).boundary["pulled"].t.text = "-4";
  const MembraneScene scene = membrane_scene(params);
  EXPECT_EQ(*scene.tension[0]->constant(), 2);
  EXPECT_EQ(*scene.default_boundary.value[0]->constant(), 0.5);
  EXPECT_EQ(*scene.boundary.at("wall").value[0]->constant(), 3);
  EXPECT_EQ(*scene.boundary.at("rest").value[0]->constant(), 0.5);
  EXPECT_EQ(scene.boundary.at("pulled").kind, BoundaryKind::neumann);
  EXPECT_EQ(*scene.boundary.at("pulled").value[0]->constant(), -4);
  EXPECT_EQ(*scene.boundary.at("free").value[0]->constant(), 0);
  for (const auto& [tag, condition] : scene.boundary) EXPECT_EQ(condition.value[1], nullptr) << tag;
}

TEST(MembraneScene, wants_either_a_case_or_data) {
  models::SceneParams params{model::two, {}, {}};
  EXPECT_EQ(message_of([&] { membrane_scene(params); }),
            "scene: nothing says which problem to solve; give a catalogued 'case' or a sublist 'data'.");
  params = by_height("1", "0");
  params.case_name = "disk";
  EXPECT_EQ(message_of([&] { membrane_scene(params); }), "scene/data: there is a case as well; give either 'case' or 'data'.");
}

TEST(MembraneScene, refuses_what_can_not_be_meant) {
  models::SceneParams params = by_height("1", "");
  EXPECT_EQ(message_of([&] { membrane_scene(params); }),
            "scene/data: nothing says what u2 is on the boundary; give data/g2 or the exact solution data/u2.");
  params = by_height("1", "0");
  of(params).data->mu2.text = "-1";
  EXPECT_EQ(message_of([&] { membrane_scene(params); }), "scene/data/mu2: a tension must be positive, not -1.");
  params = by_height("1", "0");
  of(params).data->u1.text = "x";
  EXPECT_EQ(message_of([&] { membrane_scene(params); }), "scene/data/u1: the exact solution needs u2 as well; give both or none.");
  params = by_height("1", "0");
  of(params).boundary["free"].kind = BoundaryKind::neumann;
  of(params).boundary["free"].g1.text = "1";
  EXPECT_EQ(message_of([&] { membrane_scene(params); }),
            "scene/boundary/free/g1: a part of kind neumann has no g1; give t1, or kind = dirichlet.");
  params = by_height("1", "0");
  of(params).data->constants["r"] = 1;
  EXPECT_NE(message_of([&] { membrane_scene(params); }).find("scene/data/constants/r: this name has a meaning in every expression already"),
            std::string::npos);
  params = by_height("1", "0");
  of(params).data->constants = {{"sin", 1}, {"c", 1}};
  of(params).data->f1.text = "c*x";
  EXPECT_EQ(message_of([&] { membrane_scene(params); }),
            "scene/data/constants/sin: this name has a meaning in every expression already; take another one.");
  params = by_height("1", "0");
  params.model = "signorini";
  EXPECT_EQ(message_of([&] { membrane_scene(params); }),
            "scene/model: this scene is about membranes; write 'membranes', 'obstacle' or 'parabolic membranes'.");
}

TEST(MembraneScene, over_an_obstacle_refuses_what_can_not_be_meant) {
  const auto refused = [](const std::function<void(models::SceneParams&)>& spoil) {
    models::SceneParams params = over_obstacle("-1", "0");
    spoil(params);
    return message_of([&] { membrane_scene(params); });
  };
  EXPECT_EQ(refused([](auto&) {}), "no error");
  EXPECT_EQ(refused([](auto& p) { of(p).data->psi.text = ""; }),
            "scene/data/psi: nothing says where the obstacle is; give psi, its height.");
  EXPECT_EQ(refused([](auto& p) { of(p).data->g.text = ""; }),
            "scene/data: nothing says what u is on the boundary; give data/g or the exact solution data/u.");
  EXPECT_EQ(refused([](auto& p) { of(p).data->mu.text = "1 - 1"; }), "scene/data/mu: a tension must be positive, not 1 - 1.");
  EXPECT_EQ(refused([](auto& p) { of(p).data->psi.text = "1/0"; }), "scene/data/psi: '1/0' is not a finite number.");
  EXPECT_NE(refused([](auto& p) { of(p).data->constants["pi"] = 3; }).find("scene/data/constants/pi: this name has a meaning"),
            std::string::npos);
  EXPECT_EQ(refused([](auto& p) { of(p).data->lambda.text = "1"; }),
            "scene/data/lambda: an exact multiplier is of use together with u only; give u or drop lambda.");
  EXPECT_EQ(refused([](auto& p) { of(p).data->u.text = of(p).data->u_x.text = "1"; }), "scene/data/u_x: give both u_x and u_y or none.");
  EXPECT_EQ(refused([](auto& p) { of(p).data->u_x.text = of(p).data->u_y.text = "1"; }),
            "scene/data/u_x: the gradient of the exact solution needs u itself; give it or drop the gradient.");
  EXPECT_EQ(refused([](auto& p) {
              of(p).boundary["free"].kind = BoundaryKind::neumann;
              of(p).boundary["free"].g.text = "1";
            }),
            "scene/boundary/free/g: a part of kind neumann has no g; give t, or kind = dirichlet.");
  EXPECT_EQ(refused([](auto& p) { of(p).boundary["wall"].t.text = "1"; }),
            "scene/boundary/wall/t: a part of kind dirichlet has no t; give g, or kind = neumann.");
  EXPECT_EQ(refused([](auto& p) {
              of(p).data->g.text = "";
              of(p).boundary["wall"];
            }),
            "scene/boundary/wall: give g here or in data.");
}

TEST(MembraneScene, refuses_the_functions_of_the_other_model_by_one_sentence_each) {
  models::SceneParams params = over_obstacle("-1", "");
  of(params).data->g1.text = "0";
  of(params).data->u2_x.text = "0";
  of(params).boundary["wall"].t2.text = "1";
  EXPECT_EQ(message_of([&] { membrane_scene(params); }),
            "scene/data/g1: there is one membrane; write g in place of g1.\n"
            "scene/data/u2_x: the obstacle psi takes the place of the lower membrane; drop u2_x, or write model = 'membranes'.\n"
            "scene/boundary/wall/t2: the obstacle psi takes the place of the lower membrane; drop t2, or write model = 'membranes'.");
  params = by_height("1", "");
  of(params).data->f.text = "-8";
  of(params).data->psi.text = "-1";
  of(params).boundary["wall"].g.text = "1";
  EXPECT_EQ(message_of([&] { membrane_scene(params); }),
            "scene/data/f: there are two membranes; write f1 and f2 in place of f, or model = 'obstacle'.\n"
            "scene/boundary/wall/g: there are two membranes; write g1 and g2 in place of g, or model = 'obstacle'.\n"
            "scene/data/psi: the lower membrane takes the place of an obstacle; drop psi, or write model = 'obstacle'.");
}

TEST(MembraneScene, reports_all_unreadable_expressions_at_once) {
  models::SceneParams params = by_height("1", "0");
  of(params).data->f1.text = "sin(";
  of(params).data->f2.text = "1 + z";
  const std::string message = message_of([&] { membrane_scene(params); });
  EXPECT_EQ(message.find("scene/data/f1: "), 0u) << message;
  EXPECT_NE(message.find("\nscene/data/f2: "), std::string::npos) << message;
}

const models::Catalogue& known() {
  static const models::Catalogue catalogue({}, {family()});
  return catalogue;
}
models::SceneParams parse(const std::string& inside) {
  return core::Deck::from_text(
             "<ParameterList name=\"thixis\">\n<ParameterList name=\"scene\">\n" + inside + "</ParameterList>\n</ParameterList>", "d.xml")
      .parse(known().schema())
      .scene;
}
const std::string two_membranes = "<Parameter name=\"model\" type=\"string\" value=\"membranes\"/>\n";
const std::string obstacle = "<Parameter name=\"model\" type=\"string\" value=\"obstacle\"/>\n";

TEST(SceneDeck, names_a_case_or_brings_data) {
  EXPECT_EQ(parse(two_membranes + "<Parameter name=\"case\" type=\"string\" value=\"disk b\"/>\n").case_name, "disk b");
  const models::SceneParams params =
      parse(two_membranes +
            "<ParameterList name=\"data\">\n<Parameter name=\"mu1\" type=\"double\" value=\"2\"/>\n"
            "<Parameter name=\"g1\" type=\"string\" value=\"c*x\"/>\n<Parameter name=\"g2\" type=\"double\" value=\"-1\"/>\n"
            "<ParameterList name=\"constants\">\n<Parameter name=\"c\" type=\"double\" value=\"3\"/>\n</ParameterList>\n"
            "</ParameterList>\n<ParameterList name=\"boundary\">\n<ParameterList name=\"left\">\n"
            "<Parameter name=\"kind\" type=\"string\" value=\"neumann\"/>\n</ParameterList>\n</ParameterList>\n");
  const MembraneScene scene = membrane_scene(params);
  Sample sample;
  sample.add(2, 0);
  EXPECT_EQ(sample(scene.default_boundary.value[0])[0], 6);
  EXPECT_EQ(*scene.tension[0]->constant(), 2);
  EXPECT_EQ(scene.boundary.at("left").kind, BoundaryKind::neumann);
}

TEST(SceneDeck, describes_a_membrane_over_an_obstacle) {
  const MembraneScene scene = membrane_scene(
      parse(obstacle +
            "<ParameterList name=\"data\">\n<Parameter name=\"mu\" type=\"double\" value=\"2\"/>\n"
            "<Parameter name=\"f\" type=\"int\" value=\"-8\"/>\n<Parameter name=\"g\" type=\"string\" value=\"x + 1\"/>\n"
            "<Parameter name=\"psi\" type=\"string\" value=\"min(x, y)\"/>\n<Parameter name=\"u\" type=\"string\" value=\"x*y\"/>\n"
            "<Parameter name=\"u_x\" type=\"string\" value=\"y\"/>\n<Parameter name=\"u_y\" type=\"string\" value=\"x\"/>\n"
            "<Parameter name=\"lambda\" type=\"double\" value=\"7\"/>\n</ParameterList>\n<ParameterList name=\"boundary\">\n"
            "<ParameterList name=\"left\">\n<Parameter name=\"kind\" type=\"string\" value=\"neumann\"/>\n"
            "<Parameter name=\"t\" type=\"double\" value=\"5\"/>\n</ParameterList>\n<ParameterList name=\"right\">\n"
            "<Parameter name=\"g\" type=\"double\" value=\"6\"/>\n</ParameterList>\n</ParameterList>\n"));
  Sample sample;
  sample.add(2, 3);
  EXPECT_EQ(scene.count, 1);
  EXPECT_EQ(*scene.tension[0]->constant(), 2);
  EXPECT_EQ(*scene.force[0]->constant(), -8);
  EXPECT_EQ(sample(scene.default_boundary.value[0])[0], 3);
  EXPECT_EQ(sample(scene.obstacle)[0], 2);
  EXPECT_EQ(sample(scene.exact->u[0])[0], 6);
  EXPECT_EQ(sample(scene.exact->gradient[0][0])[0], 3);
  EXPECT_EQ(sample(scene.exact->gradient[0][1])[0], 2);
  EXPECT_EQ(*scene.exact->multiplier->constant(), 7);
  EXPECT_EQ(*scene.boundary.at("left").value[0]->constant(), 5);
  EXPECT_EQ(*scene.boundary.at("right").value[0]->constant(), 6);
}

TEST(SceneDeck, says_file_and_line_of_a_function_of_the_other_model_and_of_what_is_missing) {
  const std::string g = "<Parameter name=\"g\" type=\"double\" value=\"0\"/>\n", f1 = "<Parameter name=\"f1\" type=\"int\" value=\"0\"/>\n";
  const auto refused = [](const std::string& functions) {
    return message_of([&] { parse(obstacle + "<ParameterList name=\"data\">\n" + functions + "</ParameterList>\n"); });
  };
  EXPECT_EQ(refused(g + f1), "d.xml:6: scene/data/f1: there is one membrane; write f in place of f1.");
  EXPECT_EQ(refused(g), "d.xml:4: scene/data/psi: nothing says where the obstacle is; give psi, its height.");
}

TEST(SceneDeck, says_file_and_line_of_an_expression_that_can_not_be_read) {
  const std::string message = message_of([] {
    parse(two_membranes +
          "<ParameterList name=\"data\">\n<Parameter name=\"g1\" type=\"double\" value=\"0\"/>\n<Parameter name=\"g2\" type=\"double\" "
          "value=\"0\"/>\n"
          "<Parameter name=\"f1\" type=\"string\" value=\"sin(\"/>\n</ParameterList>\n");
  });
  EXPECT_EQ(message.find("d.xml:7: scene/data/f1: "), 0u) << message;
}

TEST(SceneDeck, offers_the_nearest_case) {
  const std::string message = message_of([] { parse(two_membranes + "<Parameter name=\"case\" type=\"string\" value=\"disc b\"/>\n"); });
  EXPECT_NE(message.find("disk b"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(SceneDeck, is_written_and_read_again) {
  const auto text = [](const models::SceneParams& scene) {
    models::RunParams params = known().defaults();
    params.scene = scene;
    return core::to_xml(known().schema(), params);
  };
  for (const std::string& inside :
       {two_membranes + "<Parameter name=\"case\" type=\"string\" value=\"disk b\"/>\n",
        two_membranes + "<ParameterList name=\"data\">\n<Parameter name=\"g1\" type=\"string\" value=\"x &lt; 0 ? 1 : 2\"/>\n"
                        "<Parameter name=\"g2\" type=\"double\" value=\"-1\"/>\n</ParameterList>\n",
        obstacle + "<Parameter name=\"case\" type=\"string\" value=\"torsion\"/>\n",
        obstacle + "<ParameterList name=\"data\">\n<Parameter name=\"g\" type=\"double\" value=\"0\"/>\n"
                   "<Parameter name=\"psi\" type=\"string\" value=\"-r\"/>\n</ParameterList>\n"}) {
    const std::string written = text(parse(inside));
    const models::SceneParams again = core::Deck::from_text(written, "again.xml").parse(known().schema()).scene;
    EXPECT_EQ(text(again), written);
    EXPECT_NO_THROW(membrane_scene(again)) << written;
  }
}

TEST(SceneDeck, says_to_which_model_a_case_belongs) {
  const std::string message = message_of([] { parse(obstacle + "<Parameter name=\"case\" type=\"string\" value=\"disk\"/>\n"); });
  EXPECT_EQ(message, "d.xml:4: scene/case: 'disk' is a case of another model; write model = 'membranes' or take one of its own.");
}

TEST(SceneDeck, must_say_which_problem_to_solve) {
  EXPECT_EQ(message_of([] { parse(two_membranes); }),
            "d.xml:2: scene: nothing says which problem to solve; give a catalogued 'case' or a sublist 'data'.");
}

TEST(SceneDeck, names_the_degree_of_its_data_and_not_that_of_the_exact_solution) {
  models::SceneParams params{model::two, {}, {}};
  params.model = model::obstacle;
  of(params).data.emplace();
  of(params).data->u.text = "sin(x)", of(params).data->psi.text = "-abs(x)", of(params).data->degree = 1;
  const MembraneScene scene = membrane_scene(params);
  ASSERT_TRUE(scene.obstacle->degree());
  EXPECT_EQ(scene.obstacle->degree()->space, 1);
  EXPECT_FALSE(scene.obstacle->degree()->whole);
  EXPECT_FALSE(scene.default_boundary.value[0]->degree());
  EXPECT_TRUE(scene.force[0]->degree());
}

TEST(StartDeck, every_name_of_the_start_reaches_its_member) {
  core::Deck deck = core::Deck::from_text(R"(<ParameterList name="thixis"/>)", "d.xml");
  for (const char* given : {"scene/model=membranes", "scene/case=disk", "newton/initial/u=x*y", "newton/initial/u1=1 - r",
                            "newton/initial/u2=0.5", "newton/initial/lambda=2"})
    deck.set(given);
  const StartParams initial = deck.parse(known().schema()).newton.own.get<NewtonParams>().initial;
  EXPECT_EQ(initial.u->text, "x*y");
  EXPECT_EQ(initial.u1->text, "1 - r");
  EXPECT_EQ(initial.u2->text, "0.5");
  EXPECT_EQ(initial.lambda->text, "2");
}

}  // namespace
}  // namespace thixis::membranes
