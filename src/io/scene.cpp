#include "io/scene.hpp"

#include <fmt/format.h>

#include "carom/error.hpp"
#include "io/json_text.hpp"
#include "io/scene_parts.hpp"

namespace carom::io {
namespace {

using nlohmann::json;

constexpr int format_version = 1;

constexpr std::pair<std::string_view, Integrator> integrators[] = {
    {"semi_implicit_euler", Integrator::semi_implicit_euler},
    {"explicit_euler", Integrator::explicit_euler},
    {"verlet", Integrator::verlet},
    {"rk4", Integrator::rk4}};

constexpr std::pair<std::string_view, Impacts> impact_methods[] = {{"simultaneous", Impacts::simultaneous},
                                                                   {"sequential", Impacts::sequential}};

constexpr std::pair<std::string_view, JointMethod> joint_methods[] = {{"automatic", JointMethod::automatic},
                                                                      {"direct", JointMethod::direct},
                                                                      {"iterative", JointMethod::iterative}};

template <int D>
void read_world(const Value& value, WorldDefinition<D>& world, double& step) {
    const auto length_of_step = [&](const Value& v) {
        read(v, step);
        if (!(step > 0 && step <= 1)) v.refuse("is not above 0 and at most 1 s");
    };
    const auto integrator = [&](const Value& v) {
        read_choice<Integrator>(v, integrators, world.integrator);
    };
    const auto impacts = [&](const Value& v) { read_choice<Impacts>(v, impact_methods, world.impacts); };
    const auto joints = [&](const Value& v) { read_choice<JointMethod>(v, joint_methods, world.joints); };
    read_object(
        value, {field("gravity", world.gravity), field("step", length_of_step),
                field("substeps", world.substeps), field("integrator", integrator), field("impacts", impacts),
                field("joints", joints), field("sleep", world.sleep), field("continuous", world.continuous),
                not_negative("restitution_threshold", world.restitution_threshold),
                not_negative("hit_speed", world.hit_speed)});
}

void read_materials(const Value& value, Materials& materials) {
    for_each_entry(value, [&](const Value& material) {
        read_object(material, material_fields(materials[std::string(material.key())]));
    });
}

template <int D>
Scene read_scene(const Value& document) {
    Scene scene;
    scene.where = document.where();
    auto& data = scene.data.emplace<SceneData<D>>();
    Materials materials;
    const auto ignore = [](const Value&) {};
    // Materials come before the bodies that are made of them, and bodies before the joints and forces that
    // name them.
    read_object(document, {field("carom", ignore), field("dimension", ignore), field("name", scene.name),
                           field("world", [&](const Value& v) { read_world(v, data.world, scene.step); }),
                           field("materials", [&](const Value& v) { read_materials(v, materials); }),
                           field("bodies", [&](const Value& v) { read_bodies(v, materials, data); }),
                           field("joints", [&](const Value& v) { read_joints(v, data); }),
                           field("forces", [&](const Value& v) { read_forces(v, data); })});
    return scene;
}

/// Calls `add` and puts the place in the file before what it refuses.
template <class Add>
auto at(const Scene& scene, const std::string& place, Add add) {
    try {
        return add();
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}.{}", scene.where, place, error.what()));
    }
}

/// The force with the handles of the world in place of the indices of the scene.
template <int D>
ForceDefinition<D> with_handles(ForceDefinition<D> force, const std::vector<BodyId<D>>& bodies) {
    const auto handle = [&](auto& id) {
        if constexpr (requires { id.has_value(); }) {
            if (id) id = bodies[id->index];
        } else {
            id = bodies[id.index];
        }
    };
    const auto visit = [&](auto& kind) {
        if constexpr (requires { kind.body; }) handle(kind.body);
        if constexpr (requires { kind.a; }) handle(kind.a);
        if constexpr (requires { kind.b; }) handle(kind.b);
    };
    std::visit(visit, force.kind);
    return force;
}

/// The same for a joint.
template <int D>
JointDefinition<D> with_handles(JointDefinition<D> joint, const std::vector<BodyId<D>>& bodies,
                                const std::vector<JointId<D>>& joints) {
    if (joint.a) joint.a = bodies[joint.a->index];
    if (joint.b) joint.b = bodies[joint.b.index];
    const auto visit = [&](auto& kind) {
        if constexpr (requires { kind.joint_a; }) {
            kind.joint_a = joints[kind.joint_a.index];
            kind.joint_b = joints[kind.joint_b.index];
        }
    };
    std::visit(visit, joint.kind);
    return joint;
}

}  // namespace

Scene parse_scene(std::string_view text, std::string_view where) {
    const json content = parse_json(text, where);
    const Value document(content, where);

    const Value version(document, member(document, "carom"), "carom");
    if (version.json() != format_version)
        version.refuse(fmt::format("is not supported by this version; allowed is {}", format_version));
    const Value dimension(document, member(document, "dimension"), "dimension");
    if (dimension.json() == 2) return read_scene<2>(document);
    if (dimension.json() == 3) return read_scene<3>(document);
    dimension.refuse("is neither 2 nor 3");
}

Scene load_scene(const std::filesystem::path& path) {
    Scene scene = parse_scene(read_text_file(path), path.string());
    if (scene.name.empty()) scene.name = path.stem().string();
    return scene;
}

template <int D>
SceneWorld<D> build(const Scene& scene) {
    const auto& data = std::get<SceneData<D>>(scene.data);
    SceneWorld<D> result{at(scene, "world", [&] { return World<D>(data.world); }), {}, {}, {}};
    for (std::size_t i = 0; i < data.bodies.size(); ++i)
        result.bodies.push_back(
            at(scene, fmt::format("bodies[{}]", i), [&] { return result.world.add_body(data.bodies[i]); }));
    for (std::size_t i = 0; i < data.joints.size(); ++i)
        result.joints.push_back(at(scene, fmt::format("joints[{}]", i), [&] {
            return result.world.add_joint(with_handles(data.joints[i], result.bodies, result.joints));
        }));
    for (std::size_t i = 0; i < data.forces.size(); ++i)
        result.forces.push_back(at(scene, fmt::format("forces[{}]", i), [&] {
            return result.world.add_force(with_handles(data.forces[i], result.bodies));
        }));
    return result;
}

template SceneWorld<2> build(const Scene&);
template SceneWorld<3> build(const Scene&);

std::string body_label(std::string_view name, std::size_t index) {
    return name.empty() ? fmt::format("#{}", index) : std::string(name);
}

}  // namespace carom::io
