# Brings the staged files of each package into the form that Debian's policy requires.  Run by cpack.
set(source ${CMAKE_CURRENT_LIST_DIR})
find_program(GZIP gzip REQUIRED)

# cpack runs dpkg-shlibdeps, which reads the programs of a cross build with the tools of their architecture.
if(CPACK_DEBIAN_PACKAGE_ARCHITECTURE)
  set(ENV{DEB_HOST_ARCH} ${CPACK_DEBIAN_PACKAGE_ARCHITECTURE})
endif()

function(compress file)
  execute_process(COMMAND ${GZIP} -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(package IN LISTS CPACK_COMPONENTS_ALL)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${package})
  file(GLOB programs ${root}/usr/bin/*)
  if(programs)
    execute_process(COMMAND ${CPACK_A351_STRIP} --remove-section=.comment --remove-section=.note ${programs} COMMAND_ERROR_IS_FATAL ANY)
  endif()
  file(GLOB_RECURSE pages ${root}/usr/share/man/*.[1-8])
  foreach(page IN LISTS pages)
    compress(${page})
  endforeach()

  set(doc ${root}/usr/share/doc/${package})
  file(COPY ${source}/copyright DESTINATION ${doc})
  configure_file(${source}/changelog ${doc}/changelog.Debian COPYONLY)
  configure_file(${source}/../../CHANGELOG.md ${doc}/changelog COPYONLY)
  if(package STREQUAL a351)
    file(COPY ${source}/README.Debian DESTINATION ${doc})
  endif()
  compress(${doc}/changelog.Debian)
  compress(${doc}/changelog)
endforeach()

# Units are below /lib on Debian 12, and below /usr/lib on Debian 13, whose dpkg is 1.22.
execute_process(COMMAND dpkg-query -W -f "\${Version}" dpkg OUTPUT_VARIABLE dpkg_version COMMAND_ERROR_IS_FATAL ANY)
if(dpkg_version VERSION_LESS 1.22)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/a351)
  file(MAKE_DIRECTORY ${root}/lib)
  file(RENAME ${root}/usr/lib/systemd ${root}/lib/systemd)
endif()

# Permissions do not depend on the umask; file times are that of the last change, not of the build.
execute_process(COMMAND chmod -R u=rwX,go=rX ${CPACK_TEMPORARY_DIRECTORY} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND find ${CPACK_TEMPORARY_DIRECTORY} -exec touch --no-dereference --date=@$ENV{SOURCE_DATE_EPOCH} {} +
                COMMAND_ERROR_IS_FATAL ANY)
