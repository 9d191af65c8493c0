# The report's page: page.html with its styles, scripts and the charting library (npm, package-lock.json) in it, as one
# string of the library scree_runtime. A new section of the page is one file and its line here, in the order of the page.
set(report_scripts
    dom.js format.js curves.js chart.js table.js
    sections/headline.js
    sections/sweep_measures.js
    sections/sweep_table.js
    sections/sweep_charts.js
    sections/case_words.js
    sections/differences.js
    sections/flow.js
    sections/meters.js
    sections/pictures.js
    sections/averages.js
    sections/touch.js
    sections/residence.js
    sections/checks.js
    sections/performance.js
    sections/files.js
    page.js)
list(TRANSFORM report_scripts PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/report/)
set(report_sources ${CMAKE_CURRENT_SOURCE_DIR}/report/page.html ${CMAKE_CURRENT_SOURCE_DIR}/report/style.css ${report_scripts})

find_program(NPM npm)
set(report_build ${CMAKE_CURRENT_BINARY_DIR}/report)
set(report_npm_files ${CMAKE_CURRENT_SOURCE_DIR}/report/package.json ${CMAKE_CURRENT_SOURCE_DIR}/report/package-lock.json)
add_custom_command(
  OUTPUT ${report_build}/npm_installed
  COMMAND ${CMAKE_COMMAND} -D "NPM=$<$<BOOL:${NPM}>:${NPM}>" -D SOURCE=${CMAKE_CURRENT_SOURCE_DIR}/report -D FOLDER=${report_build}
          -P ${CMAKE_CURRENT_SOURCE_DIR}/report/install_library.cmake
  DEPENDS ${report_npm_files} ${CMAKE_CURRENT_SOURCE_DIR}/report/install_library.cmake
  COMMENT "Installing the report's charting library" VERBATIM)
add_custom_command(
  OUTPUT ${report_build}/report_page.cpp
  COMMAND ${CMAKE_COMMAND} -D SOURCE=${CMAKE_CURRENT_SOURCE_DIR}/report -D "SCRIPTS=${report_scripts}"
          -D LIBRARY=${report_build}/node_modules/uplot -D OUT=${report_build}/report_page.cpp
          -P ${CMAKE_CURRENT_SOURCE_DIR}/report/bundle.cmake
  DEPENDS ${report_build}/npm_installed ${report_sources} ${CMAKE_CURRENT_SOURCE_DIR}/report/bundle.cmake
  COMMENT "Bundling the report's page" VERBATIM)
set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/report.cpp PROPERTIES COMPILE_DEFINITIONS SCREE_VERSION="${PROJECT_VERSION}")
target_sources(scree_runtime PRIVATE ${report_build}/report_page.cpp)
