# Writes the bill of materials of the packages next to them, as SPDX 2.3 (JSON): the Debian packages of the libraries that
# they link, of the headers and files that were compiled into them, and of the compiler.  Run by cpack after the packages.
# https://spdx.github.io/spdx-spec/v2.3/

set(packages "")       # Entries of the document.
set(relations "")
set(described "")      # Debian packages that have an entry.
set(checksums "")      # Checksums of the packages built here.

function(output_of variable)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE text OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

function(id_of variable name)
  string(REPLACE "+" "x" name "${name}")  # An identifier has letters, digits, dots and dashes.
  set(${variable} "SPDXRef-${name}" PARENT_SCOPE)
endfunction()

# Adds the entry of a package; MORE are lines of JSON that end with a comma.
function(add_package name version supplier license more)
  id_of(id ${name})
  set(entry "    {
      \"SPDXID\": \"${id}\",
      \"name\": \"${name}\",
      \"versionInfo\": \"${version}\",
      \"supplier\": \"${supplier}\",
${more}      \"downloadLocation\": \"NOASSERTION\",
      \"filesAnalyzed\": false,
      \"licenseConcluded\": \"NOASSERTION\",
      \"licenseDeclared\": \"${license}\",
      \"copyrightText\": \"NOASSERTION\"
    }")
  list(APPEND packages "${entry}")
  set(packages "${packages}" PARENT_SCOPE)
endfunction()

function(relate subject type object)
  id_of(from ${subject})
  id_of(to ${object})
  list(APPEND relations
       "    {\"spdxElementId\": \"${from}\", \"relationshipType\": \"${type}\", \"relatedSpdxElement\": \"${to}\"}")
  set(relations "${relations}" PARENT_SCOPE)
endfunction()

# Adds an entry for a package of this system, once.  If a cross build has it for two architectures, the target's is used.
function(describe name)
  if(NOT name IN_LIST described)
    set(query dpkg-query -W -f "\${Version}|\${Architecture}|\${source:Package}|\${source:Version}")
    execute_process(COMMAND ${query} ${name}:${CPACK_DEBIAN_PACKAGE_ARCHITECTURE} OUTPUT_VARIABLE fields ERROR_QUIET)
    if(NOT fields)
      output_of(fields ${query} ${name})
    endif()
    string(REPLACE "|" ";" fields "${fields}")
    list(GET fields 0 version)
    list(GET fields 1 architecture)
    list(GET fields 2 source)
    list(GET fields 3 source_version)
    set(locator "${name}@${version}")
    string(REPLACE "+" "%2B" locator "${locator}")
    string(REPLACE ":" "%3A" locator "${locator}")
    add_package(${name} ${version} "Organization: ${vendor}" NOASSERTION "      \"sourceInfo\": \"built from ${source} ${source_version}\",
      \"externalRefs\": [{\"referenceCategory\": \"PACKAGE-MANAGER\", \"referenceType\": \"purl\",
        \"referenceLocator\": \"pkg:deb/${vendor}/${locator}?arch=${architecture}&distro=${vendor}-${release}\"}],
")
    list(APPEND described ${name})
  endif()
  set(packages "${packages}" PARENT_SCOPE)
  set(described "${described}" PARENT_SCOPE)
endfunction()

# Finds the installed package of a name; the package may only provide this name.
function(provider_of variable name)
  execute_process(COMMAND dpkg-query -W -f "\${Version}" ${name} OUTPUT_VARIABLE version ERROR_QUIET)
  if(NOT version)
    output_of(provided dpkg-query -W -f "\${Package}, \${Provides}, \n")
    string(REPLACE "\n" ";" provided "${provided}")
    string(REPLACE "+" "\\+" pattern "${name}")
    list(FILTER provided INCLUDE REGEX " ${pattern}( \\([^)]*\\))?, ")
    string(REGEX REPLACE ",.*" "" name "${provided}")
  endif()
  set(${variable} ${name} PARENT_SCOPE)
endfunction()

# Finds the packages of this system that contain the files: each once, sorted.
function(owners_of variable)
  execute_process(COMMAND dpkg-query -S ${ARGN} OUTPUT_VARIABLE text ERROR_VARIABLE errors)
  if(errors)
    message(WARNING "files that are not from Debian packages are missing in the SBOM: ${errors}")
  endif()
  # A line is PACKAGE[:ARCHITECTURE][, ...]: FILE.
  string(REGEX REPLACE ": [^\n]*\n" ";" owners "${text}")
  string(REPLACE ", " ";" owners "${owners}")
  list(TRANSFORM owners REPLACE ":.*$" "")
  list(REMOVE_ITEM owners "")
  list(SORT owners)
  list(REMOVE_DUPLICATES owners)
  set(${variable} "${owners}" PARENT_SCOPE)
endfunction()

# Collects the system files that were compiled into programs, from their objects and other inputs; headers separately.
function(compiled_into headers_variable files_variable)
  list(TRANSFORM ARGN PREPEND bin/)
  output_of(inputs ${CPACK_A351_NINJA} -C ${CPACK_A351_BUILD} --quiet -t inputs ${ARGN})
  string(REPLACE "\n" ";" inputs "${inputs}")
  set(objects ${inputs})
  list(FILTER objects INCLUDE REGEX "\\.(o|gch)$")
  output_of(headers ${CPACK_A351_NINJA} -C ${CPACK_A351_BUILD} --quiet -t deps ${objects})
  string(REPLACE "\n" ";" headers "${headers}")
  list(TRANSFORM headers STRIP)
  list(REMOVE_DUPLICATES headers)
  list(FILTER headers INCLUDE REGEX "^/usr/")
  list(FILTER inputs INCLUDE REGEX "^/usr/")
  list(FILTER inputs EXCLUDE REGEX "\\.so(\\.[0-9.]+)?$")
  set(${headers_variable} "${headers}" PARENT_SCOPE)
  set(${files_variable} "${inputs}" PARENT_SCOPE)
endfunction()

file(STRINGS /etc/os-release lines REGEX "^(ID|VERSION_ID)=")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^.*=\"?([^\"]*)\"?$" "\\1" value "${line}")
  if(line MATCHES "^ID=")
    set(vendor ${value})
  else()
    set(release ${value})
  endif()
endforeach()

file(REAL_PATH ${CPACK_A351_COMPILER} compiler)
owners_of(compiler_package ${compiler})
list(SORT CPACK_PACKAGE_FILES)
foreach(deb IN LISTS CPACK_PACKAGE_FILES)
  output_of(name dpkg-deb -f ${deb} Package)
  output_of(version dpkg-deb -f ${deb} Version)
  output_of(architecture dpkg-deb -f ${deb} Architecture)
  output_of(depends dpkg-deb -f ${deb} Depends)
  file(SHA256 ${deb} checksum)
  list(APPEND checksums ${checksum})
  cmake_path(GET deb FILENAME file)
  add_package(${name} ${version} "Organization: the a351 authors" MIT "      \"packageFileName\": \"${file}\",
      \"checksums\": [{\"algorithm\": \"SHA256\", \"checksumValue\": \"${checksum}\"}],
")
  relate(DOCUMENT DESCRIBES ${name})

  # dpkg-shlibdeps wrote these; an entry with alternatives is not a library.
  string(REGEX REPLACE ", *" ";" depends "${depends}")
  list(FILTER depends EXCLUDE REGEX "\\|")
  list(TRANSFORM depends REPLACE " .*$" "")
  foreach(library IN LISTS depends)
    provider_of(library ${library})
    describe(${library})
    relate(${name} DYNAMIC_LINK ${library})
  endforeach()

  file(GLOB programs RELATIVE ${CPACK_TEMPORARY_DIRECTORY}/${name}/usr/bin ${CPACK_TEMPORARY_DIRECTORY}/${name}/usr/bin/*)
  if(NOT programs)
    continue()
  endif()
  compiled_into(headers files ${programs})
  owners_of(header_packages ${headers})
  foreach(package IN LISTS header_packages)
    describe(${package})
    relate(${name} STATIC_LINK ${package})
  endforeach()
  if(files)
    owners_of(file_packages ${files})
    foreach(package IN LISTS file_packages)
      describe(${package})
      relate(${name} CONTAINS ${package})
    endforeach()
  endif()
  foreach(package IN LISTS compiler_package)
    describe(${package})
    relate(${package} BUILD_TOOL_OF ${name})
  endforeach()
endforeach()

set(document "a351_${version}_${architecture}")
string(SHA256 checksum "${checksums}")
string(TIMESTAMP created "%Y-%m-%dT%H:%M:%SZ" UTC)  # Uses SOURCE_DATE_EPOCH, which date.cmake sets.
list(JOIN packages ",\n" packages)
list(JOIN relations ",\n" relations)
file(WRITE ${CPACK_PACKAGE_DIRECTORY}/${document}.spdx.json "{
  \"spdxVersion\": \"SPDX-2.3\",
  \"dataLicense\": \"CC0-1.0\",
  \"SPDXID\": \"SPDXRef-DOCUMENT\",
  \"name\": \"${document}\",
  \"documentNamespace\": \"https://a351.invalid/spdx/${document}-${checksum}\",
  \"creationInfo\": {
    \"created\": \"${created}\",
    \"creators\": [\"Tool: a351-sbom-${version}\"],
    \"comment\": \"DYNAMIC_LINK: shared libraries; STATIC_LINK: headers compiled in, declarations as well as templates; CONTAINS: other files compiled in.\"
  },
  \"packages\": [
${packages}
  ],
  \"relationships\": [
${relations}
  ]
}
")
message(STATUS "SBOM: ${CPACK_PACKAGE_DIRECTORY}/${document}.spdx.json")
