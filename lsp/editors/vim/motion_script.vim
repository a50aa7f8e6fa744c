" Vim 8 and newer with ALE: in .vimrc, behind what loads plugins.
augroup motion_script
  autocmd!
  autocmd BufRead,BufNewFile *.ms set filetype=motion-script commentstring=#\ %s
augroup END

function! MotionScriptRoot(buffer) abort
  let l:found = ale#path#FindNearestFile(a:buffer, 'mlmg.toml')
  return fnamemodify(empty(l:found) ? bufname(a:buffer) : l:found, ':p:h')
endfunction

call ale#linter#Define('motion-script', {
\   'name': 'mlmg',
\   'lsp': 'stdio',
\   'executable': 'mlmg',
\   'command': '%e lsp --stdio --position-encoding utf-8',
\   'language': 'motion-script',
\   'project_root': function('MotionScriptRoot'),
\})
let g:ale_completion_enabled = 1
