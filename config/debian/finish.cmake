# Brings the staged files of each package into the form that Debian's policy asks for; run by cpack.
set(source ${CMAKE_CURRENT_LIST_DIR})
find_program(GZIP gzip REQUIRED)
find_program(STRIP strip REQUIRED)

function(compress file)
  execute_process(COMMAND ${GZIP} -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(package IN LISTS CPACK_COMPONENTS_ALL)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${package})
  file(GLOB programs ${root}/usr/bin/*)
  execute_process(COMMAND ${STRIP} --remove-section=.comment --remove-section=.note ${programs} COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE pages ${root}/usr/share/man/*.[1-8])
  foreach(page IN LISTS pages)
    compress(${page})
  endforeach()

  set(doc ${root}/usr/share/doc/${package})
  file(COPY ${source}/copyright DESTINATION ${doc})
  configure_file(${source}/changelog ${doc}/changelog.Debian COPYONLY)
  configure_file(${source}/../../CHANGELOG.md ${doc}/changelog COPYONLY)
  compress(${doc}/changelog.Debian)
  compress(${doc}/changelog)
  file(CHMOD_RECURSE ${doc}
    FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ
    DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
endforeach()

# Where Debian 12 keeps units and rules.
set(root ${CPACK_TEMPORARY_DIRECTORY}/a351)
foreach(folder IN ITEMS systemd udev)
  file(MAKE_DIRECTORY ${root}/lib)
  file(RENAME ${root}/usr/lib/${folder} ${root}/lib/${folder})
endforeach()
