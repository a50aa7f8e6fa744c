;; What `drive_emacs.el' asks for, with lsp-mode.
;; As an Emacs with an init file does before it reads that: it knows then where all of lsp-mode is.
(package-initialize)
(require 'lsp-mode)
(require 'lsp-completion)
(setq lsp-auto-guess-root t
      lsp-response-timeout 60
      lsp-restart 'ignore
      lsp-diagnostics-provider :flymake
      lsp-enable-snippet nil)

(defun drive-join ()
  "Have the server serve this buffer: what would be done when Emacs has nothing else to do."
  (lsp))

(defun drive-told ()
  "Return what is underlined, and the first line of what is said of it."
  (mapcar (lambda (one)
            (pcase-let ((`(,start . ,end) (lsp--range-to-region (lsp:diagnostic-range one))))
              (vector (buffer-substring-no-properties start end)
                      (car (split-string (lsp:diagnostic-message one) "\n")))))
          (lsp--get-buffer-diagnostics)))

(defun drive-completions () (lsp-completion-at-point))
(defun drive-fix () (call-interactively #'lsp-execute-code-action))
(defun drive-format () (lsp-format-buffer))
(defun drive-rename (name) (lsp-rename name))

(defun drive-hover ()
  "Return what the help buffer shows of what is under the cursor."
  (lsp-describe-thing-at-point)
  (with-current-buffer "*lsp-help*" (buffer-string)))
