# The replay viewer: a web page made by npm from web/replay, copied into the build folder first so that
# the source tree stays clean, then embedded into the program as a string.
# Sets carom_replay_source, the generated source file that defines carom::io::replay_template().
set(carom_replay_source ${PROJECT_BINARY_DIR}/replay_template.cpp)

if(CAROM_BUILD_REPLAY)
    find_program(CAROM_NODE NAMES node nodejs REQUIRED)
    find_program(CAROM_NPM npm REQUIRED)
    set(from ${PROJECT_SOURCE_DIR}/web/replay)
    set(to ${PROJECT_BINARY_DIR}/replay)

    file(GLOB page_sources RELATIVE ${from} CONFIGURE_DEPENDS ${from}/*.json ${from}/*.mjs ${from}/.npmrc)
    file(GLOB_RECURSE page_modules RELATIVE ${from} CONFIGURE_DEPENDS ${from}/src/*)
    set(copies)
    foreach(file IN LISTS page_sources page_modules)
        add_custom_command(OUTPUT ${to}/${file} DEPENDS ${from}/${file}
                           COMMAND ${CMAKE_COMMAND} -E copy ${from}/${file} ${to}/${file})
        list(APPEND copies ${to}/${file})
    endforeach()

    add_custom_command(
        OUTPUT ${to}/installed.stamp DEPENDS ${to}/package.json ${to}/package-lock.json
        COMMAND ${CAROM_NPM} ci --no-audit --no-fund --prefer-offline --loglevel=error
        COMMAND ${CMAKE_COMMAND} -E touch installed.stamp
        WORKING_DIRECTORY ${to} COMMENT "Fetching what the replay viewer is made of")
    add_custom_command(
        OUTPUT ${to}/dist/replay.html DEPENDS ${copies} ${to}/installed.stamp
        COMMAND ${CAROM_NPM} run --silent build
        WORKING_DIRECTORY ${to} COMMENT "Building the replay viewer")
    add_custom_command(
        OUTPUT ${carom_replay_source} DEPENDS ${to}/dist/replay.html ${PROJECT_SOURCE_DIR}/cmake/embed.mjs
        COMMAND ${CAROM_NODE} ${PROJECT_SOURCE_DIR}/cmake/embed.mjs ${to}/dist/replay.html ${carom_replay_source}
        COMMENT "Embedding the replay viewer")
    # A string of this length is more than the standard asks of a compiler, and more than it needs to warn of.
    set_source_files_properties(${carom_replay_source} PROPERTIES COMPILE_OPTIONS "-w")
else()
    file(CONFIGURE OUTPUT ${carom_replay_source} CONTENT [[
#include "io/replay_template.hpp"

std::string_view carom::io::replay_template() { return {}; }
]])
endif()
