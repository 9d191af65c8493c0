# Writes OUT, a C++ file with the report's page as one string:
#   cmake -D SOURCE=<runtime/report> -D SCRIPTS=<a;b;c> -D LIBRARY=<node_modules/uplot> -D OUT=<file.cpp> -P bundle.cmake
cmake_minimum_required(VERSION 3.25)
file(READ ${SOURCE}/page.html page)
file(READ ${SOURCE}/style.css style)
set(library_style "")  # without the library (install_library.cmake) the page's charts say so
set(library_script "")
set(library_licence "")
if(EXISTS ${LIBRARY}/dist/uPlot.iife.min.js)
  file(READ ${LIBRARY}/dist/uPlot.min.css library_style)
  file(READ ${LIBRARY}/dist/uPlot.iife.min.js library_script)
  file(READ ${LIBRARY}/LICENSE library_licence)
endif()
set(scripts "")
foreach(file ${SCRIPTS})
  file(READ ${file} script)
  string(APPEND scripts "${script}\n")
endforeach()

string(REPLACE "@LICENCE@" "${library_licence}" page "${page}")
string(REPLACE "@STYLE@" "${library_style}\n${style}" page "${page}")
string(REPLACE "@LIBRARY@" "${library_script}" page "${page}")
string(REPLACE "@SCRIPTS@" "${scripts}" page "${page}")
file(WRITE ${OUT} "#include \"runtime/report.h\"\nnamespace scree {\n"
                  "const std::string_view kReportPage = R\"page(${page})page\";\n}  // namespace scree\n")
