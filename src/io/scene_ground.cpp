#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "carom/error.hpp"
#include "io/obj.hpp"
#include "io/scene_parts.hpp"

namespace carom::io {
namespace {

void read_index(const Value& value, std::uint64_t most, std::uint64_t& index) {
    read(value, index);
    if (index > most) value.refuse(fmt::format("is more than {}", most));
}

/// The fields by which a ground chooses a material for each of its facets or cells. The materials come first.
template <class Ground>
Fields material_choice(Ground& ground, const Materials& materials) {
    const auto names = [&](const Value& list) {
        for_each_element(list, [&](const Value& name) {
            std::string written;
            ground.materials.push_back(read_material(name, materials, written));
        });
    };
    const auto choice = [&](const Value& list) {
        for_each_element(list, [&](const Value& value) {
            std::uint64_t index = 0;
            read_index(value, std::numeric_limits<std::uint16_t>::max(), index);
            ground.material_of.push_back(static_cast<std::uint16_t>(index));
        });
    };
    return {field("materials", names), field("material_of", choice)};
}

void read_height(const Value& value, double& height) {
    height = std::numeric_limits<double>::quiet_NaN();
    if (!value.json().is_null()) read(value, height);
}

void read_row(const Value& list, std::vector<double>& row) {
    for_each_element(list, [&](const Value& value) { read_height(value, row.emplace_back()); });
}

}  // namespace

const Material& read_material(const Value& value, const Materials& materials, std::string& name) {
    read(value, name);
    const auto found = materials.find(name);
    if (found == materials.end()) {
        std::vector<std::string_view> known;
        for (const auto& [known_name, known_material] : materials) known.push_back(known_name);
        value.refuse(fmt::format("is not a material of this scene{}", suggestion(name, known)));
    }
    return found->second;
}

Fields chain_fields(Geometry<2>& geometry, const Materials& materials) {
    Chain& chain = geometry.emplace<Chain>();
    return Fields{required("points", chain.points), field("loop", chain.loop),
                  field("two_sided", chain.two_sided)} +
           material_choice(chain, materials);
}

Fields mesh_fields(Geometry<3>& geometry, const Materials& materials) {
    Mesh& mesh = geometry.emplace<Mesh>();
    const auto triangles = [&mesh](const Value& list) {
        for_each_element(list, [&](const Value& triangle) {
            if (!triangle.json().is_array() || triangle.json().size() != 3)
                triangle.refuse("is not a list of 3 indices of vertices");
            std::size_t next = 0;
            auto& corners = mesh.triangles.emplace_back();
            for_each_element(triangle, [&](const Value& value) {
                std::uint64_t index = 0;
                read_index(value, std::numeric_limits<std::uint32_t>::max(), index);
                corners[next++] = static_cast<std::uint32_t>(index);
            });
        });
    };
    const auto file = [&mesh](const Value& value) {
        if (!mesh.vertices.empty() || !mesh.triangles.empty())
            value.refuse("stands beside \"vertices\" or \"triangles\"; one of both says what the mesh is");
        std::string name;
        read(value, name);
        const auto folder = std::filesystem::path(value.where()).parent_path();
        try {
            Mesh loaded = load_obj(folder / name);
            mesh.vertices = std::move(loaded.vertices);
            mesh.triangles = std::move(loaded.triangles);
        } catch (const Error& error) {
            value.fail(error.what());
        }
    };
    return Fields{field("vertices", mesh.vertices), field("triangles", triangles), field("file", file),
                  field("two_sided", mesh.two_sided)} +
           material_choice(mesh, materials);
}

template <int D>
Fields height_field_fields(Geometry<D>& geometry, const Materials& materials) {
    HeightField<D>& ground = geometry.template emplace<HeightField<D>>();
    const auto heights = [&ground](const Value& list) {
        if constexpr (D == 2)
            read_row(list, ground.heights);
        else
            for_each_element(list, [&](const Value& row) { read_row(row, ground.heights.emplace_back()); });
    };
    const auto spacing = [&ground](const Value& value) {
        if (D == 2 || value.json().is_number()) {
            read(value, ground.spacing[0]);
            ground.spacing.fill(ground.spacing[0]);
            return;
        }
        if constexpr (D == 3) {
            if (!value.json().is_array() || value.json().size() != 2)
                value.refuse("is neither a number nor a list of 2 numbers [along x, along z]");
            std::size_t next = 0;
            for_each_element(value, [&](const Value& part) { read(part, ground.spacing[next++]); });
        }
    };
    return Fields{required("heights", heights), required("spacing", spacing)} +
           material_choice(ground, materials);
}

template Fields height_field_fields<2>(Geometry<2>&, const Materials&);
template Fields height_field_fields<3>(Geometry<3>&, const Materials&);

}  // namespace carom::io
