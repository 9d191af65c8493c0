# Installs the charting library into FOLDER by its package-lock.json. Without npm or its registry the rest of Scree is
# built all the same, and the report says that it has no charts:
#   cmake -D NPM=<npm or empty> -D SOURCE=<runtime/report> -D FOLDER=<folder> -P install_library.cmake
file(MAKE_DIRECTORY ${FOLDER})
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${FOLDER})
set(failed 1)
if(NPM)
  execute_process(COMMAND ${NPM} ci --prefix ${FOLDER} --ignore-scripts --no-audit --no-fund --loglevel=error
                  RESULT_VARIABLE failed)
endif()
if(failed)
  message(WARNING "The report's charting library could not be installed (npm: '${NPM}'), so reports will have no charts. "
                  "To try again: remove ${FOLDER} and build.")
  file(REMOVE_RECURSE ${FOLDER}/node_modules)
endif()
file(TOUCH ${FOLDER}/npm_installed)
