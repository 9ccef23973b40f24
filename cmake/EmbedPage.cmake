# cmake -DOUT=… -DPAGE=… -DVEGA=… -P EmbedPage.cmake
#
# Writes the C++ source that holds the parts of the report's page: template, style, chart
# specifications and scripts, Vega's modules from the folder VEGA among them, each after those that
# it needs.
set(vega_modules util canvas time format loader dataflow statistics scale scenegraph expression
    event-selector selection functions parser runtime view transforms encode view-transforms)
set(charts trajectories sweep_error sweep_bounds keyframe_error keyframe_bounds keyframe_nees
    update_cost pareto registrations outcomes regimes forest)
set(page_scripts state units rows marks scales drawing charts sweep cards tables verdict mosaics controls access selftest)

# A raw string of a file; adjacent ones are joined by the compiler.
function(literal_of path variable)
  file(READ "${path}" content)
  if("${content}" MATCHES "\\)page\"|@@")
    message(FATAL_ERROR "${path} cannot be embedded: it holds what ends a raw string")
  endif()
  set(${variable} "R\"page(${content})page\"" PARENT_SCOPE)
endfunction()

literal_of("${PAGE}/page.html" template)
literal_of("${PAGE}/page.css" style)

set(specs "\"{\"\n")
set(comma "")
foreach(chart IN LISTS charts)
  literal_of("${PAGE}/charts/${chart}.json" content)
  string(APPEND specs "R\"page(${comma}\"${chart}\": )page\" ${content}\n")
  set(comma ",")
endforeach()
string(APPEND specs "\"}\"\n")

literal_of("${PAGE}/errors.js" errors)
literal_of("${PAGE}/vega_shim.js" shim)
literal_of("${PAGE}/vega_licence.txt" licence)
literal_of("${PAGE}/vega_start.js" start)
set(scripts "\"<script>\\n\" ${errors} ${shim} \"</script>\\n<!--\\n\" ${licence} \"-->\\n\"\n")
foreach(module IN LISTS vega_modules)
  literal_of("${VEGA}/vega-${module}.min.js" content)
  string(APPEND scripts "\"<script>vegaModule = 'vega-${module}';\\n\"\n${content}\n\"</script>\\n\"\n")
endforeach()
string(APPEND scripts "\"<script>\\n\" ${start}\n")
foreach(script IN LISTS page_scripts)
  literal_of("${PAGE}/${script}.js" content)
  string(APPEND scripts "${content}\n")
endforeach()
string(APPEND scripts "\"</script>\\n\"\n")

file(WRITE "${OUT}" "// Made by cmake/EmbedPage.cmake from src/report/page and Vega.
#include \"page_parts.hpp\"

namespace fathom {

const std::string_view kPageTemplate =
${template};
const std::string_view kPageStyle =
${style};
const std::string_view kPageSpecs =
${specs};
const std::string_view kPageScripts =
${scripts};

}  // namespace fathom
")
