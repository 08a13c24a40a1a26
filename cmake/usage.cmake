# The man page and the completions of the shells, printed by the built tool and installed where each looks for them.
set(usage ${PROJECT_BINARY_DIR}/usage)
set(printed)
function(prints file folder)
  add_custom_command(OUTPUT ${usage}/${file} COMMAND ${CMAKE_COMMAND} -E make_directory ${usage}
    COMMAND ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0 $<TARGET_FILE:fieldproof> ${ARGN} > ${usage}/${file}
    DEPENDS fieldproof VERBATIM)
  install(FILES ${usage}/${file} DESTINATION ${folder})
  set(printed ${printed} ${usage}/${file} PARENT_SCOPE)
endfunction()
prints(fieldproof ${CMAKE_INSTALL_DATADIR}/bash-completion/completions completion bash)
prints(_fieldproof ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions completion zsh)
prints(fieldproof.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d completion fish)
prints(fieldproof.1 ${CMAKE_INSTALL_MANDIR}/man1 man)
add_custom_target(fieldproof_usage ALL DEPENDS ${printed})
