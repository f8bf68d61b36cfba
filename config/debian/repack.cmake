# Packs each package again with an Installed-Size that does not depend on the file system of the build: cpack counts the
# blocks of folders.  The rule of dpkg-gencontrol is used: KiB of each file, rounded up, and 1 KiB per folder.
# Run by cpack.
foreach(deb IN LISTS CPACK_PACKAGE_FILES)
  set(tree ${CPACK_TEMPORARY_DIRECTORY}/repacked)
  file(REMOVE_RECURSE ${tree})
  execute_process(COMMAND dpkg-deb --raw-extract ${deb} ${tree} COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE entries LIST_DIRECTORIES true ${tree}/*)
  list(FILTER entries EXCLUDE REGEX "/repacked/DEBIAN(/|$)")
  set(installed_kib 0)
  foreach(entry IN LISTS entries)
    set(kib 1)
    if(NOT IS_DIRECTORY ${entry})
      file(SIZE ${entry} bytes)
      math(EXPR kib "(${bytes} + 1023) / 1024")
    endif()
    math(EXPR installed_kib "${installed_kib} + ${kib}")
  endforeach()
  file(READ ${tree}/DEBIAN/control control)
  string(REGEX REPLACE "Installed-Size: [0-9]+" "Installed-Size: ${installed_kib}" control "${control}")
  file(WRITE ${tree}/DEBIAN/control "${control}")
  execute_process(COMMAND chmod -R u=rwX,go=rX ${tree} COMMAND_ERROR_IS_FATAL ANY)
  # The output of xz depends on whether it uses one thread or several.
  execute_process(COMMAND dpkg-deb --root-owner-group --threads-max=1 -Zxz --build ${tree} ${deb}
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE_RECURSE ${tree})
endforeach()
